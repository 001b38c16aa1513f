surface wood(
    point c0 = (0, 0, 0),
          c1 = (1, 0, 0);
    float grain = 5, swirl = .25, swirlfreq = 1, c0bright = .6;
    color darkcolor = (0.2, 0.05, 0.02); string space = "shader";
    float Ka=.4,Kd=.6 )
{
    point NN, V, PP, PQ;
    float my_t, r, r2;
    PP = transform("shader", P);
    PQ = PP * 8;
    PP += noise(PQ) * swirl;
    r = sqrt(ycomp(PP)*ycomp(PP) + zcomp(PP)*zcomp(PP)) * grain;
    r += abs(noise(r)) ;
    r -= floor(r);
    r = smoothstep(0, .8, r) - smoothstep(.83, 1, r);
    my_t = distance(c0, c1);
    Ci = mix(Cs, darkcolor, r);
    NN = normalize(faceforward(N,I));
    Oi = Os;
    Ci = Os * Ci * (Ka*ambient() + Kd*diffuse(NN)) * my_t;
}

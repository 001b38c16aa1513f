/* brushedmetal: fine scratches that run around an axis, so that highlights stretch across them, after Ward.
     along        roughness along the scratches
     across       roughness across them
     direction    "u" or "v": the way they run; "turned": around z of shader space, as on a lathe
     metal        colour */
surface brushedmetal(
    float Ka = 1, Ks = 1, along = .06, across = .4, scratches = 1;
    string direction = "u";
    color metal = color(.78, .75, .72);)
{
    normal Nn = normalize(N);
    vector V = -normalize(I);
    vector X = normalize(dPdu);
    float pattern = v * 400;
    if (direction == "v") {
        X = normalize(dPdv);
        pattern = u * 400;
    } else if (direction == "turned") {
        vector axis = vtransform("shader", "current", vector(0, 0, 1));
        X = normalize(axis ^ Nn);
        point Q = transform("shader", P);
        pattern = 120 * sqrt(xcomp(Q) * xcomp(Q) + ycomp(Q) * ycomp(Q)) + 120 * zcomp(Q);
    }
    float fade = 1 - smoothstep(.5, 2, abs(Du(pattern) * du) + abs(Dv(pattern) * dv));
    normal Nf = faceforward(normalize(Nn + scratches * .1 * fade * (noise(pattern) - .5) * (Nn ^ X)), I);
    vector Y = Nf ^ X;
    X = normalize(Y ^ Nf);
    color sum = 0;
    illuminance(P, Nf, PI / 2) {
        float nonspecular = 0;
        lightsource("__nonspecular", nonspecular);
        vector l = normalize(L);
        vector h = normalize(l + V);
        float nl = Nf . l, nv = max(.02, Nf . V), nh = max(.02, Nf . h);
        float x = (X . h) / along, y = (normalize(Y) . h) / across;
        float lobe = exp(-2 * (x * x + y * y) / (1 + nh)) / (4 * along * across * sqrt(max(.02, nl * nv)));
        sum += Cl * (1 - nonspecular) * nl * min(lobe, 12) * Ks;
    }
    /* The room around it, as a spread of traced rays across the scratches. */
    color room = 0;
    float i;
    for (i = -2; i <= 2; i += 1) {
        vector h = normalize(Nf + i * .5 * across * normalize(Y));
        room += trace(P, reflect(-V, h)) / 5;
    }
    Oi = Os;
    Ci = Os * Cs * metal * (Ka * ambient() + .25 * sum + .8 * room);
}

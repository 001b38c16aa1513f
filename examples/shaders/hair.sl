/* hair: light on strands, after Kajiya and Kay: what counts is the angle to the strand, not to a surface. On curves the strand runs along v;
   on other shapes it is combed from pole to pole. Each strand has its own tint, dark at the root and bleached at the tip.
     rootcolor, tipcolor   colours along v
     strands               on shapes that are no curves: strands around u; 0 for curves
     Kd Ks                 of the body and of the gloss
     roughness             of the gloss; a second one, coloured and shifted toward the tip, lies behind it */
color strandlight(vector along, V; color body; float Kd, Ks, roughness)
{
    extern point P;
    color sum = 0;
    float tilt = .12;
    illuminance(P) {
        float nondiffuse = 0, nonspecular = 0;
        vector l = normalize(L);
        float tl = along . l, tv = along . V;
        float sinl = sqrt(max(0, 1 - tl * tl)), sinv = sqrt(max(0, 1 - tv * tv));
        lightsource("__nondiffuse", nondiffuse);
        lightsource("__nonspecular", nonspecular);
        float gloss = pow(clamp(sinl * sinv - tl * tv, 0, 1), 1 / roughness);
        vector shifted = normalize(along - tilt * V);
        float sl = shifted . l, sv = shifted . V;
        float glow = pow(clamp(sqrt(max(0, 1 - sl * sl)) * sqrt(max(0, 1 - sv * sv)) - sl * sv, 0, 1), .35 / roughness);
        sum += Cl * ((1 - nondiffuse) * Kd * sinl * body + (1 - nonspecular) * Ks * (gloss + .6 * glow * body));
    }
    return sum;
}

surface hair(
    color rootcolor = color(.16, .07, .03), tipcolor = color(.55, .3, .12);
    float strands = 220, Ka = 1, Kd = .55, Ks = .35, roughness = .03;)
{
    vector along = normalize(dPdv);
    color body = mix(rootcolor, tipcolor, smoothstep(.1, 1, v));
    if (strands > 0) {
        /* Strands as cells around u that wave a little; every one leans its own way. */
        float wave = u * strands + 1.5 * sin(v * 12 + 4 * noise(u * 8)) * noise(v * 3, u * 5);
        float which = floor(wave), across = mod(wave, 1);
        along = normalize(along + .12 * (cellnoise(which) - .5) * normalize(dPdu));
        float blur = clamp(abs(Du(wave) * du) + abs(Dv(wave) * dv), 0, 1);
        body *= mix(.45 + .9 * float cellnoise(which + .5) * (.4 + .6 * sin(PI * across)), .75, blur);
    } else {
        body *= .8 + .4 * float cellnoise(u);
    }
    vector V = -normalize(I);
    normal Nf = faceforward(normalize(N), I);
    /* What lies behind the strand toward the light shades it. */
    Oi = Os;
    Ci = Os * Cs * (Ka * body * ambient() + strandlight(along, V, body, Kd, Ks, roughness) * (.35 + .65 * max(0, Nf . V)));
}

// Stone of noise(): colour and bumps, beside stones.rib.
surface stones(float Ka = .3, Kd = .8, size = 6) {
    point p = transform("object", P) * size;
    float height = 0, share = 1, i;
    for (i = 0; i < 4; i += 1) {
        height += share * (float noise(p) - .5);
        p *= 2.03;
        share *= .5;
    }
    normal n = faceforward(normalize(calculatenormal(P + .06 * height * normalize(N))), I);
    color dark = .5 * Cs;
    Oi = Os;
    Ci = Os * mix(dark, Cs, smoothstep(-.4, .4, height)) * (Ka * ambient() + Kd * diffuse(n));
}

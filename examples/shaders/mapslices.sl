/* mapslices: slices of a block of stuff, one below the other, for maps.rib: shells about a middle, shaken by noise. */
surface mapslices(float slices = 48;)
{
    float z = floor(t * slices), y = t * slices - z;
    point p = point(s, y, (z + .5) / slices);
    vector d = p - point(.5, .5, .5);
    float wave = 0, i, size = 1;
    for (i = 0; i < 4; i += 1) {
        wave += (noise(p * (5 * size)) - .5) / size;
        size *= 2;
    }
    float r = 2 * length(d) + .45 * wave, ring = .5 + .5 * sin(22 * r);
    Ci = mix(color(.52, .18, .09), color(.96, .80, .48), ring);
    Ci = mix(Ci, color(.10, .28, .36), smoothstep(.85, 1.0, r));
    Oi = 1;
}

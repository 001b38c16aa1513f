/* wallpaper: stripes and a motif drawn by rule, stamped with a text's hash: every "name" gives another pattern, and always the same one.
     name      of the pattern
     repeats   along s
     ground, figure   colours */
surface wallpaper(string name = "alpenglow"; float repeats = 10, Ka = 1, Kd = .9; color ground = color(.82, .76, .62), figure = color(.35, .1, .12);)
{
    float seed = stringhash(name);
    float petals = 3 + floor(5 * cellnoise(mod(seed, 977))), stripes = 2 + floor(4 * cellnoise(mod(seed, 983) + .5));
    float x = s * repeats, y = t * repeats / 2;
    float shift = .5 * mod(floor(x), 2);
    float cx = mod(x, 1) - .5, cy = mod(y + shift, 1) - .5;
    float r = sqrt(cx * cx + cy * cy), angle = atan(cy, cx);
    float w = abs(Du(x) * du) + abs(Dv(x) * dv) + 1e-4;
    float edge = .17 + .1 * cos(petals * angle);
    float motif = 1 - smoothstep(edge - w, edge + w, r);
    float eye = 1 - smoothstep(.05 - w, .05 + w, r);
    float band = .5 + .5 * cos(2 * PI * x * stripes);
    color C = mix(ground * (.93 + .07 * band), figure, motif);
    C = mix(C, ground, eye);
    Oi = Os;
    Ci = Os * Cs * C * (Ka * ambient() + Kd * diffuse(faceforward(normalize(N), I)));
}

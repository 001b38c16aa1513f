/* cloth: twill of two yarns, warp and weft, each rounded, twisted and slightly uneven; retro-reflecting fuzz at the rim.
     threads     along s; half as many along t
     warp, weft  colours */
surface cloth(float threads = 90, Ka = 1, Kd = .9, fuzz = .25; color warp = color(.12, .2, .42), weft = color(.75, .72, .62);)
{
    float x = s * threads, y = t * threads / 2;
    float cx = floor(x), cy = floor(y);
    float up = mod(cx + cy, 3) < 1.5 ? 1 : 0;            /* twill: two over, one under */
    float fx = x - cx - .5, fy = y - cy - .5;
    float across = up > .5 ? fx : fy, alongyarn = up > .5 ? y : x;
    float w = abs(Du(x) * du) + abs(Dv(x) * dv);
    float seen = 1 - smoothstep(.5, 1.5, w);
    vector side = up > .5 ? normalize(dPdu) : normalize(dPdv);
    float twist = .5 + .5 * sin(2 * PI * (alongyarn * 2 + across * 1.5));
    normal Nf = faceforward(normalize(N), I);
    normal Ny = normalize(Nf + seen * 1.4 * across * side);
    color yarn = up > .5 ? warp * (.85 + .3 * float cellnoise(cx)) : weft * (.85 + .3 * float cellnoise(cy + 40));
    color C = mix(mix(warp, weft, 1 / 3), yarn * (.8 + .2 * twist) * (1 - .7 * pow(2 * abs(across), 4)), seen);
    vector V = -normalize(I);
    float rim = pow(1 - max(0, Nf . V), 3);
    Oi = Os;
    Ci = Os * Cs * C * (Ka * ambient() + Kd * diffuse(Ny) + fuzz * rim * (1 + diffuse(Nf)));
}

/* parquet: planks in herringbone pattern on s and t, varnished. Every plank is a piece of another board.
     planks      widths of a plank in a unit of s
     length      of a plank, in its widths
     light, dark   woods; a board lies between them
     varnish     strength of the coat */
surface parquet(float planks = 12, length = 4, Ka = 1, Kd = .8, varnish = .6; color light = color(.66, .42, .22), dark = color(.36, .18, .08);)
{
    float x = s * planks, y = t * planks * .5;
    float col = floor(x), row = floor(y), n = floor(length + .5);
    /* Herringbone: on the diagonal stripes a plank lies along x or along y. */
    float k = mod(col - row, 2 * n);
    float flat = k < n ? 1 : 0;
    float along, across, board;
    if (flat > .5) {
        along = x - (col - k);
        across = y - row;
        board = cellnoise(col - k, row);
    } else {
        along = y - (row - (2 * n - 1 - k));
        across = x - col;
        board = cellnoise(col + 31, row - (2 * n - 1 - k));
    }
    float w = abs(Du(x) * du) + abs(Dv(x) * dv) + abs(Du(y) * du) + abs(Dv(y) * dv);
    float gap = .04;
    float inside = (smoothstep(gap - w, gap + w, across) - smoothstep(1 - gap - w, 1 - gap + w, across)) *
                   (smoothstep(gap - w, gap + w, along) - smoothstep(n - gap - w, n - gap + w, along));
    float grain = noise(along * 1.5 + 40 * board, across * 14 + 90 * board);
    float ring = .5 + .5 * sin(20 * (across + .3 * noise(along * .6, board * 50)) + 30 * board);
    color C = mix(light, dark, clamp(.15 + .55 * board + .25 * grain + .2 * ring - .2, 0, 1)) * mix(.35, 1, inside);
    normal Nf = faceforward(normalize(N), I);
    vector V = -normalize(I);
    float kr, kt;
    fresnel(-V, Nf, 1 / 1.45, kr, kt);
    Oi = Os;
    Ci = Os * Cs * (kt * C * (Ka * ambient() + Kd * diffuse(Nf)) + inside * varnish * (kr * trace(P, reflect(-V, Nf)) + .4 * specular(Nf, V, .05)));
}

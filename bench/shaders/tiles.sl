// Staggered tiles with edges filtered by the footprint, each tile of a shade of its own.
float width(float x) { return max(1e-5, abs(Du(x)) * du + abs(Dv(x)) * dv); }
float inside(float x, margin, w) { return smoothstep(margin - w, margin + w, x) * (1 - smoothstep(1 - margin - w, 1 - margin + w, x)); }
surface tiles(float rows = 24, columns = 9, gap = 0.05;)
{
    float y = v * rows, x = u * columns;
    if (mod(floor(y), 2) > 0.5) x += 0.5;
    float wx = width(x), wy = width(y);
    float column = floor(x), row = floor(y);
    float tile = inside(x - column, gap, wx) * inside(y - row, gap * 2, wy);
    color glaze = color(0.6, 0.2, 0.15) * (0.75 + 0.5 * float cellnoise(column, row));
    Ci = mix(color(0.55, 0.55, 0.5), glaze, tile);
    Oi = 1;
}

/* maptile: a picture for the wrap modes of maps.rib: an arrow to the upper right on a ground whose colour changes. s, t from 0 to 1. */
surface maptile()
{
    float x = s, y = 1 - t;
    color ground = mix(color(.16, .30, .46), color(.75, .60, .30), x) * (.55 + .45 * y);
    float shaft = (1 - smoothstep(.055, .065, abs(x - y))) * step(.4, x + y) * (1 - step(1.35, x + y));
    float head = step(x, .84) * step(y, .84) * step(1.22, x + y);
    float rim = 1 - smoothstep(.03, .04, min(min(x, 1 - x), min(y, 1 - y)));
    Ci = mix(ground, color(.95, .93, .88), max(shaft, head));
    Ci = mix(Ci, color(.08, .08, .10), rim);
    Oi = 1;
}

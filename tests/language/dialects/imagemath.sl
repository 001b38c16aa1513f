imager tonemap(float exposure = 1, gam = 2.2, bits = 8; color key = color(0,1,0); string mode = "reinhard")
{
    color reinhard(color c) { return c / (1 + c); }
    float curve(float x) { return pow(max(x, 0), 1/gam); }
    color c = Ci * exposure; float k;
    if (mode == "reinhard") c = reinhard(c);
    else if (mode == "exp") c = color(1 - exp(-comp(c,0)), 1 - exp(-comp(c,1)), 1 - exp(-comp(c,2)));
    c = color(curve(c[0]), curve(c[1]), curve(c[2]));
    k = 1 / (pow(2, bits) - 1);
    c += k * (random() - .5);
    if (distance(point(key[0], key[1], key[2]), point(c[0], c[1], c[2])) < .1) alpha = 0;
    Ci = clamp(c, color(0), color(1)); Oi = alpha;
}

surface heatmap(varying float temperature = 0; float lo = 0, hi = 1; float nan_ = 0)
{
#define RANGE ((hi) - (lo) == 0 ? 1 : (hi) - (lo))
    float x = clamp((temperature - lo) / RANGE, 0, 1);
    /* jet */
    float r = clamp(1.5 - abs(4*x - 3), 0, 1), g = clamp(1.5 - abs(4*x - 2), 0, 1), b = clamp(1.5 - abs(4*x - 1), 0, 1);
    Ci = color(r, g, b); Oi = 1; if (nan_) Ci = 0;
    float lines = mod(x * 10, 1);
    if (lines < .05 * (1 + filterwidth_(x * 10))) Ci *= .2;
}
float filterwidth_(float x) { return max(abs(Du(x)*extern_du()), 1e-5); }
float extern_du() { extern float du; return du; }

/* Functions of SeExpr, for patterns that are expressions (docs/ris.md). Vectors of SeExpr are colours here. */
#ifndef SEEXPR_H
#define SEEXPR_H
point se_p(color c;) { return point(comp(c, 0), comp(c, 1), comp(c, 2)); }
float se_noise(color p;) { return float noise(se_p(p)); }
color se_cnoise(color p;) { return color noise(se_p(p)); }
float se_snoise(color p;) { return 2 * float noise(se_p(p)) - 1; }
color se_vnoise(color p;) { return 2 * color noise(se_p(p)) - color(1); }
float se_cellnoise(color p;) { return float cellnoise(se_p(p)); }
color se_ccellnoise(color p;) { return color cellnoise(se_p(p)); }
float se_turbulence(color p; float octaves, lacunarity, gain;) {
    float i, sum = 0, a = 1;
    point q = se_p(p);
    for (i = 0; i < min(octaves, 20); i += 1) {
        sum += a * abs(2 * float noise(q) - 1);
        a *= gain;
        q = q * lacunarity;
    }
    return sum;
}
float se_fbm(color p; float octaves, lacunarity, gain;) {
    float i, sum = 0, a = 1;
    point q = se_p(p);
    for (i = 0; i < min(octaves, 20); i += 1) {
        sum += a * (2 * float noise(q) - 1);
        a *= gain;
        q = q * lacunarity;
    }
    return .5 * sum + .5;
}
float se_voronoi(color p; float kind, jitter;) {
    point q = se_p(p), cell = point(floor(xcomp(q)), floor(ycomp(q)), floor(zcomp(q)));
    float f1 = 1e3, f2 = 1e3, i, j, k, id = 0;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1)
            for (k = -1; k <= 1; k += 1) {
                point at = cell + vector(i + .5, j + .5, k + .5);
                float d = distance(at + jitter * (vector cellnoise(at) - vector(.5, .5, .5)), q);
                if (d < f1) { f2 = f1; f1 = d; id = float cellnoise(at); } else if (d < f2) f2 = d;
            }
    return (kind == 1) ? id : (kind == 3) ? f2 : (kind == 4) ? f2 - f1 : f1;
}
float se_length(color a;) { return sqrt(comp(a, 0) * comp(a, 0) + comp(a, 1) * comp(a, 1) + comp(a, 2) * comp(a, 2)); }
float se_dot(color a, b;) { return comp(a, 0) * comp(b, 0) + comp(a, 1) * comp(b, 1) + comp(a, 2) * comp(b, 2); }
float se_dist(color a, b;) { return se_length(a - b); }
color se_norm(color a;) { float l = se_length(a); return (l > 0) ? a / l : a; }
color se_cross(color a, b;) {
    return color(comp(a, 1) * comp(b, 2) - comp(a, 2) * comp(b, 1), comp(a, 2) * comp(b, 0) - comp(a, 0) * comp(b, 2), comp(a, 0) * comp(b, 1) - comp(a, 1) * comp(b, 0));
}
float se_at(color a; float i;) { return (i < .5) ? comp(a, 0) : (i < 1.5) ? comp(a, 1) : comp(a, 2); }
float se_linear(float x, a, b;) { return (a == b) ? ((x < a) ? 0 : 1) : clamp((x - a) / (b - a), 0, 1); }
float se_fit(float x, a, b, c, d;) { return (a == b) ? c : c + (d - c) * (x - a) / (b - a); }
float se_hash(float x, y, z;) { return float cellnoise(point(17.3 * x + .5, 31.7 * y + .5, 5.1 * z + .5)); }
float se_bias(float x, b;) { return (x <= 0) ? 0 : pow(x, log(clamp(b, 1e-3, .999)) / log(.5)); }
color se_hsi(color c; float h, s, i;) {
    color x = ctransform("rgb", "hsl", c);
    return ctransform("hsl", "rgb", color(mod(comp(x, 0) + h / 360, 1), clamp(comp(x, 1) * s, 0, 1), comp(x, 2) * i));
}
#endif

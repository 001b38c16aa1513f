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
color se_vfbm(color p; float octaves, lacunarity, gain;) {
    float i, a = 1;
    color sum = 0;
    point q = se_p(p);
    for (i = 0; i < min(octaves, 20); i += 1) {
        sum += a * (2 * color noise(q) - color(1));
        a *= gain;
        q = q * lacunarity;
    }
    return sum;
}
color se_cfbm(color p; float octaves, lacunarity, gain;) { return .5 * se_vfbm(p, octaves, lacunarity, gain) + color(.5); }
/* The nearest and the second nearest of sites that lie one in each cell, jitter from its middle: distances and places. */
void se_sites(color p; float jitter, warp, octaves, lacunarity, gain; output float f1, f2; output point near;) {
    color moved = p;
    if (warp > 0) moved += warp * se_vfbm(p, octaves, lacunarity, gain);
    point q = se_p(moved), cell = point(floor(xcomp(q)), floor(ycomp(q)), floor(zcomp(q)));
    float i, j, k;
    f1 = 1e3;
    f2 = 1e3;
    near = q;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1)
            for (k = -1; k <= 1; k += 1) {
                point at = cell + vector(i + .5, j + .5, k + .5), site = at + jitter * (vector cellnoise(at) - vector(.5, .5, .5));
                float d = distance(site, q);
                if (d < f1) { f2 = f1; f1 = d; near = site; } else if (d < f2) f2 = d;
            }
}
/* By the kind: 1 a number of the cell, 2 and 3 the distances, 4 their difference, 5 lines between cells of the same width. */
float se_kind(float kind, f1, f2, id;) {
    return (kind == 1) ? id : (kind == 3) ? f2 : (kind == 4) ? f2 - f1 : (kind == 5) ? 1 - smoothstep(0, .1, f2 - f1) : f1;
}
float se_voronoi(color p; float kind, jitter, warp, octaves, lacunarity, gain;) {
    float f1, f2;
    point near;
    se_sites(p, jitter, warp, octaves, lacunarity, gain, f1, f2, near);
    return se_kind(kind, f1, f2, float cellnoise(near + vector(10, 0, 0)));
}
color se_cvoronoi(color p; float kind, jitter, warp, octaves, lacunarity, gain;) {
    float f1, f2;
    point near;
    se_sites(p, jitter, warp, octaves, lacunarity, gain, f1, f2, near);
    return ((kind == 1) ? 1 : se_kind(kind, f1, f2, 1)) * color cellnoise(near + vector(10, 0, 0));
}
color se_pvoronoi(color p; float jitter, warp, octaves, lacunarity, gain;) {
    float f1, f2;
    point near;
    se_sites(p, jitter, warp, octaves, lacunarity, gain, f1, f2, near);
    return color(xcomp(near), ycomp(near), zcomp(near));
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
float se_trunc(float a;) { return (a < 0) ? ceil(a) : floor(a); }
float se_fmod(float a, b;) { return (b == 0) ? 0 : a - b * se_trunc(a / b); }
float se_cbrt(float a;) { return sign(a) * pow(abs(a), 1 / 3); }
float se_log10(float a;) { return log(a, 10); }
float se_hypot(float a, b;) { return sqrt(a * a + b * b); }
float se_sind(float a;) { return sin(radians(a)); }
float se_cosd(float a;) { return cos(radians(a)); }
float se_tand(float a;) { return tan(radians(a)); }
float se_asind(float a;) { return degrees(asin(a)); }
float se_acosd(float a;) { return degrees(acos(a)); }
float se_atand(float a;) { return degrees(atan(a)); }
float se_angle(color a, b;) {
    float l = se_length(a) * se_length(b);
    return (l > 0) ? acos(clamp(se_dot(a, b) / l, -1, 1)) : 0;
}
color se_ortho(color a, b;) { return se_norm(se_cross(a, b)); }
float se_invert(float x;) { return 1 - x; }
float se_gamma(float x, g;) { return (x <= 0) ? 0 : pow(x, 1 / g); }
float se_compress(float x, a, b;) { return a + (b - a) * x; }
float se_expand(float x, a, b;) { return (a == b) ? ((x < a) ? 0 : 1) : (x - a) / (b - a); }
/* From 0 at a to 1 at b by a bell curve; a may be above b. */
float se_gaussstep(float x, a, b;) {
    float y = (a == b) ? ((x < a) ? 1 : 0) : clamp((x - b) / (a - b), 0, 1);
    return (y >= 1) ? 0 : pow(2, -8 * y * y);
}
/* 1 within range of the source, falling to 0 over falloff: interp 0 linear, 1 smooth, 2 by a bell curve. */
float se_remap(float x, source, range, falloff, interp;) {
    float a = abs(range), b = a + abs(falloff), d = abs(x - source);
    return (a == b) ? ((d < a) ? 1 : 0) : (interp == 0) ? 1 - clamp((d - a) / (b - a), 0, 1) : (interp == 1) ? 1 - smoothstep(a, b, d) : se_gaussstep(d, b, a);
}
color se_saturate(color c; float s;) { return mix(color(.2126 * comp(c, 0) + .7152 * comp(c, 1) + .0722 * comp(c, 2)), c, color(s)); }
color se_rgbtohsl(color c;) { return ctransform("rgb", "hsl", c); }
color se_hsltorgb(color c;) { return ctransform("hsl", "rgb", c); }
float se_bias(float x, b;) { return (x <= 0) ? 0 : pow(x, log(clamp(b, 1e-3, .999)) / log(.5)); }
float se_contrast(float x, c;) { return (x < .5) ? .5 * se_bias(2 * x, 1 - c) : 1 - .5 * se_bias(2 - 2 * x, 1 - c); }
color se_hsi(color c; float h, s, i;) {
    color x = ctransform("rgb", "hsl", c);
    return ctransform("hsl", "rgb", color(mod(comp(x, 0) + h / 360, 1), clamp(comp(x, 1) * s, 0, 1), comp(x, 2) * i));
}
#endif

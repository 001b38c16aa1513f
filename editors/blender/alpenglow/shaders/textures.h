/* Blender's texture and converter nodes. Noise has the spectrum of Blender's, not its values. */
#ifndef BLENDER_TEXTURES_H
#define BLENDER_TEXTURES_H
float blToFloat(color c) { return .2126 * comp(c, 0) + .7152 * comp(c, 1) + .0722 * comp(c, 2); }
float blMean(vector v) { return (xcomp(v) + ycomp(v) + zcomp(v)) / 3; }
color blToColor(vector v) { return color(xcomp(v), ycomp(v), zcomp(v)); }
vector blToVector(color c) { return vector(comp(c, 0), comp(c, 1), comp(c, 2)); }
float blSafeDivide(float a, b) { return (b == 0) ? 0 : a / b; }

/* 8-bit maps of numbers come as if they were sRGB: back to the numbers; and a map in sRGB whose file holds floats. */
float blEncoded(float x) { return (x <= .0031308) ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - .055; }
float blDecoded(float x) { return (x <= .04045) ? x / 12.92 : pow((x + .055) / 1.055, 2.4); }
color blEncode(color c) { return color(blEncoded(comp(c, 0)), blEncoded(comp(c, 1)), blEncoded(comp(c, 2))); }
color blDecode(color c) { return color(blDecoded(comp(c, 0)), blDecoded(comp(c, 1)), blDecoded(comp(c, 2))); }

/* Checker Texture: 1 for Color1. */
float blChecker(vector p)
{
    float x = floor((xcomp(p) + .000001) * .999999), y = floor((ycomp(p) + .000001) * .999999), z = floor((zcomp(p) +
        .000001) * .999999);
    return (mod(abs(x), 2) == mod(abs(y), 2)) ? ((mod(abs(z), 2) == 0) ? 0 : 1) : ((mod(abs(z), 2) == 0) ? 1 : 0);
}
/* Signed noise of mean 0. dimensions: 1 to 4. */
float blSnoise(vector p; float w, dimensions)
{
    float n = 0;
    if (dimensions == 1) n = noise(w);
    else if (dimensions == 2) n = noise(xcomp(p), ycomp(p));
    else if (dimensions == 3) n = noise(point(xcomp(p), ycomp(p), zcomp(p)));
    else n = noise(point(xcomp(p), ycomp(p), zcomp(p)), w);
    return 2 * n - 1;
}
/* Noise Texture (fBM): octaves of falling size, the last one in part. */
float blNoise(vector at; float where, dimensions, scale, detail, roughness, lacunarity, distortion)
{
    vector p = at * scale;
    float w = where * scale, size = 1, amplitude = 1, most = 0, sum = 0, octaves = clamp(detail, 0, 15), i;
    if (distortion != 0)
        p += distortion * vector(blSnoise(p + vector(13.5, 27.2, 5.1), w, dimensions), blSnoise(p + vector(71.3, 3.9, 44.7),
            w, dimensions),
                                 blSnoise(p + vector(8.8, 61.1, 90.4), w, dimensions));
    float whole = floor(octaves);
    for (i = 0; i <= whole; i += 1) {
        sum += amplitude * blSnoise(size * p, size * w, dimensions);
        most += amplitude;
        amplitude *= clamp(roughness, 0, 1);
        size *= lacunarity;
    }
    float rest = octaves - whole, value = .5 * sum / most + .5;
    if (rest > 0) {
        float more = .5 * (sum + amplitude * blSnoise(size * p, size * w, dimensions)) / (most + amplitude) + .5;
        value = mix(value, more, rest);
    }
    return value;
}
color blNoiseColor(vector p; float w, dimensions, scale, detail, roughness, lacunarity, distortion)
{
    return color(blNoise(p, w, dimensions, scale, detail, roughness, lacunarity, distortion),
                 blNoise(p + vector(31.4, 17.7, 85.2), w + 12.3, dimensions, scale, detail, roughness, lacunarity, distortion),
                 blNoise(p + vector(95.1, 2.6, 40.9), w + 45.6, dimensions, scale, detail, roughness, lacunarity, distortion));
}
/* Voronoi Texture: distance to the nearest or second nearest point, or to the edge; colour and place of the nearest.
   metric 0: Euclidean, 1: Manhattan, 2: Chebychev; feature 0: F1, 1: F2, 2: distance to edge. */
void blVoronoi(vector at; float dimensions, scale, randomness, feature, metric; output float distance; output color c; output
    vector place)
{
    vector p = at * scale, cell = vector(floor(xcomp(p)), floor(ycomp(p)), floor(zcomp(p))), nearest = 0, second = 0;
    float d1 = 1e9, d2 = 1e9, i, j, k, deep = (dimensions == 2) ? 0 : 1;
    if (dimensions == 2) {
        p = vector(xcomp(p), ycomp(p), 0);
        cell = vector(xcomp(cell), ycomp(cell), 0);
    }
    for (k = -deep; k <= deep; k += 1)
        for (j = -1; j <= 1; j += 1)
            for (i = -1; i <= 1; i += 1) {
                vector q = cell + vector(i, j, k), r = vector cellnoise(point(xcomp(q) + .5, ycomp(q) + .5, zcomp(q) + .5));
                q += randomness * ((dimensions == 2) ? vector(xcomp(r), ycomp(r), 0) : r);
                vector d = q - p;
                float ax = abs(xcomp(d)), ay = abs(ycomp(d)), az = abs(zcomp(d));
                float far = (metric == 1) ? ax + ay + az : (metric == 2) ? max(ax, max(ay, az)) : length(d);
                if (far < d1) {
                    d2 = d1;
                    second = nearest;
                    d1 = far;
                    nearest = q;
                } else if (far < d2) {
                    d2 = far;
                    second = q;
                }
            }
    place = (feature == 1) ? second : nearest;
    c = color cellnoise(point(xcomp(place) * 7.31, ycomp(place) * 7.31, zcomp(place) * 7.31));
    distance = (feature == 1) ? d2 : d1;
    if (feature == 2) distance = (p - .5 * (nearest + second)) . normalize(nearest - second);
    place /= (scale == 0) ? 1 : scale;
}
/* Wave Texture. kind 0 bands, 1 rings; axis 0 x, 1 y, 2 z, 3 diagonal (bands) or spherical (rings); profile 0 sine, 1 saw, 2
   triangle. */
float blWave(vector at; float kind, axis, profile, scale, distortion, detail, detailscale, detailroughness, phase)
{
    vector p = (at * scale + vector(.000001, .000001, .000001)) * .999999;
    float n = 0;
    if (kind == 0) n = (axis == 0) ? 20 * xcomp(p) : (axis == 1) ? 20 * ycomp(p) : (axis == 2) ? 20 * zcomp(p) : 10 *
        (xcomp(p) + ycomp(p) + zcomp(p));
    else {
        vector r = (axis == 0) ? vector(0, ycomp(p), zcomp(p)) : (axis == 1) ? vector(xcomp(p), 0, zcomp(p)) :
            (axis == 2) ? vector(xcomp(p), ycomp(p), 0) : p;
        n = 20 * length(r);
    }
    n += phase;
    if (distortion != 0) n += distortion * (blNoise(p * detailscale, 0, 3, 1, detail, detailroughness, 2, 0) * 2 - 1);
    float turn = n / (2 * PI), value = .5 + .5 * sin(n - PI / 2);
    if (profile == 1) value = turn - floor(turn);
    if (profile == 2) value = 2 * abs(turn - floor(turn + .5));
    return value;
}
/* Gradient Texture. kind 0 linear, 1 quadratic, 2 easing, 3 diagonal, 4 radial, 5 spherical, 6 quadratic sphere. */
float blGradient(vector p; float kind)
{
    float x = xcomp(p), r = max(.999999 - length(p), 0), value = x;
    if (kind == 1) value = max(x, 0) * max(x, 0);
    if (kind == 2) value = clamp(x, 0, 1) * clamp(x, 0, 1) * (3 - 2 * clamp(x, 0, 1));
    if (kind == 3) value = (x + ycomp(p)) / 2;
    if (kind == 4) value = atan(ycomp(p), x) / (2 * PI) + .5;
    if (kind == 5) value = r;
    if (kind == 6) value = r * r;
    return clamp(value, 0, 1);
}
/* Magic Texture. */
color blMagic(vector at; float scale, distortion, depth)
{
    vector p = at * scale;
    float a = mod(xcomp(p), 2 * PI), b = mod(ycomp(p), 2 * PI), c = mod(zcomp(p), 2 * PI), d = distortion;
    float x = sin((a + b + c) * 5), y = cos((-a + b - c) * 5), z = -cos((-a - b + c) * 5);
    if (depth > 0) { x *= d; y *= d; z *= d; y = -cos(x - y + z) * d; }
    if (depth > 1) x = cos(x - y - z) * d;
    if (depth > 2) z = sin(-x - y - z) * d;
    if (depth > 3) x = -cos(-x + y - z) * d;
    if (depth > 4) y = -sin(-x + y + z) * d;
    if (depth > 5) y = -cos(-x + y + z) * d;
    if (depth > 6) x = cos(x + y + z) * d;
    if (depth > 7) z = sin(x + y - z) * d;
    if (depth > 8) x = -cos(-x - y + z) * d;
    if (depth > 9) y = -sin(x - y + z) * d;
    if (d != 0) { x /= 2 * d; y /= 2 * d; z /= 2 * d; }
    return color(.5 - x, .5 - y, .5 - z);
}
/* Brick Texture: colour of the brick's tint (0 to 1) and 1 in mortar. */
void blBrick(vector at; float scale, mortar, smooth, bias, width, height, offset, every, squash, squashevery; output float
    tint, inmortar)
{
    vector p = at * scale;
    float row = floor(ycomp(p) / height), w = width, shift = 0;
    if (every > 0 && squashevery > 0) {
        w *= (mod(row, squashevery) == 0) ? squash : 1;
        shift = (mod(row, every) == 0) ? w * offset : 0;
    }
    float brick = floor((xcomp(p) + shift) / w), x = xcomp(p) + shift - w * brick, y = ycomp(p) - height * row;
    tint = clamp(cellnoise(row + .5, brick + .5) + bias, 0, 1);
    float near = min(min(x, y), min(w - x, height - y));
    inmortar = 0;
    if (near < mortar) {
        inmortar = 1;
        if (smooth > 0 && mortar > 0) inmortar = smoothstep(0, smooth, 1 - near / mortar);
    }
}

color blHsv(color rgb) { return ctransform("rgb", "hsv", rgb); }
color blRgb(color hsv) { return ctransform("hsv", "rgb", hsv); }
/* Hue Saturation Value. */
color blHueSaturation(float hue, saturation, value, fac; color c)
{
    color h = blHsv(c);
    float turned = comp(h, 0) + hue + .5;
    color out = blRgb(color(turned - floor(turned), clamp(comp(h, 1) * saturation, 0, 1), comp(h, 2) * value));
    return mix(c, max(out, color 0), color fac);
}
color blGamma(color c; float g) { return color(pow(max(comp(c, 0), 0), g), pow(max(comp(c, 1), 0), g), pow(max(comp(c, 2),
    0), g)); }
color blContrast(color c; float bright, contrast) { return max((1 + contrast) * c + color(bright - contrast * .5), color 0); }

/* Mix colours by one of Blender's modes, in the order of its menu; a below, b above. */
color blOverlay(color f, a, b)
{
    float i;
    color out = 0;
    for (i = 0; i < 3; i += 1) {
        float t = comp(f, i), x = comp(a, i), y = comp(b, i);
        setcomp(out, i, (x < .5) ? x * (1 - t + 2 * t * y) : 1 - (1 - t + 2 * t * (1 - y)) * (1 - x));
    }
    return out;
}
color blDivide(color f, a, b)
{
    float i;
    color out = a;
    for (i = 0; i < 3; i += 1)
        if (comp(b, i) != 0) setcomp(out, i, (1 - comp(f, i)) * comp(a, i) + comp(f, i) * comp(a, i) / comp(b, i));
    return out;
}
color blDodge(color f, a, b)
{
    float i;
    color out = a;
    for (i = 0; i < 3; i += 1)
        if (comp(a, i) != 0) setcomp(out, i, (1 - comp(f, i) * comp(b, i) <= 0) ? 1 : min(1, comp(a, i) / (1 - comp(f, i) *
            comp(b, i))));
    return out;
}
color blBurn(color f, a, b)
{
    float i;
    color out = 0;
    for (i = 0; i < 3; i += 1) {
        float t = 1 - comp(f, i) + comp(f, i) * comp(b, i);
        setcomp(out, i, (t <= 0) ? 0 : clamp(1 - (1 - comp(a, i)) / t, 0, 1));
    }
    return out;
}
/* Hue, saturation, value or colour of b on a: which 0 to 3. */
color blOfHsv(float f, which; color a, b)
{
    color x = blHsv(a), y = blHsv(b), out = a;
    if (which == 2) out = blRgb(color(comp(x, 0), comp(x, 1), comp(y, 2)));
    else if (which == 1) out = (comp(x, 1) != 0) ? blRgb(color(comp(x, 0), comp(y, 1), comp(x, 2))) : a;
    else if (comp(y, 1) != 0) out = blRgb(color(comp(y, 0), (which == 0) ? comp(x, 1) : comp(y, 1), comp(x, 2)));
    return mix(a, out, color f);
}

/* Normal Map in tangent space: Blender's vertical coordinate grows with green. */
normal blNormalMap(color c; float strength; normal n; vector along, up)
{
    vector u = normalize(along - (along . n) * n), v = n ^ u;
    if (v . up < 0) v = -v;
    vector m = 2 * blToVector(c) - vector(1, 1, 1);
    normal out = normalize(normal(xcomp(m) * u + ycomp(m) * v + max(zcomp(m), 0) * vector(n)));
    return normalize(n + strength * (out - n));
}
/* Bump: a height along the normal; the slope comes from derivatives. */
normal blBump(float height, strength, way; normal n, facing)
{
    extern point P;
    extern normal Ng;
    normal bumped = calculatenormal(P + way * height * normalize(n)), flat = calculatenormal(P);
    normal out = normalize(n) + normalize(bumped) - normalize(flat);
    if (normalize(flat) . n < 0) out = normalize(n) - normalize(bumped) + normalize(flat);
    return normalize(facing + strength * (((out . facing < 0) ? -normalize(out) : normalize(out)) - facing));
}
/* The displacement of a material as a bump. moved: by how much, current space. */
normal blBumped(vector moved; normal facing)
{
    extern point P;
    normal bumped = normalize(calculatenormal(P + moved)), flat = normalize(calculatenormal(P));
    normal out = normalize(facing + ((flat . facing < 0) ? flat - bumped : bumped - flat));
    return out;
}
#endif

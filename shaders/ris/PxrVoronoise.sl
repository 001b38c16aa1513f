/* PxrVoronoise: between cells and noise, of RIS, after I. Quilez, "Voronoise" (2014): jitter 0 to 1 moves the points of the cells off a grid, smoothness 0 to 1 blends
   what they hold; octaves of it, each lacunarity times finer and gain times weaker. Over x and y of the manifold, or s and t. */
#include "rispattern.h"
surface PxrVoronoise(varying float surfacePosition = 0, frequency = 5, octaves = 1, gain = .5, lacunarity = 2, jitter = .75, smoothness = 1; RIS_MANIFOLD; RIS_RGB; output varying float resultF = 0) {
    float cells(float x, y, u, v;) {
        float k = 1 + 63 * pow(1 - v, 4), px = floor(x), py = floor(y), fx = x - px, fy = y - py, va = 0, wt = 0, i, j;
        for (j = -2; j <= 2; j += 1)
            for (i = -2; i <= 2; i += 1) {
                color o = cellnoise(px + i + .5, py + j + .5);
                float rx = i - fx + comp(o, 0) * u, ry = j - fy + comp(o, 1) * u;
                float w = pow(1 - smoothstep(0, 1.414, sqrt(rx * rx + ry * ry)), k);
                va += w * comp(o, 2);
                wt += w;
            }
        return va / max(wt, 1e-9);
    }
    RIS_COORDINATES(x, y);
    float sum = 0, total = 0, weight = 1, size = frequency, o;
    for (o = 0; o < octaves; o += 1) {
        sum += weight * cells(x * size + 7.1 * o, y * size + 3.7 * o, clamp(jitter, 0, 1), clamp(smoothness, 0, 1));
        total += weight;
        weight *= gain;
        size *= lacunarity;
    }
    resultF = sum / max(total, 1e-6);
    resultRGB = resultF;
    RIS_CHANNELS
}

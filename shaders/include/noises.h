/* Noise and sums of noise, under the names that procedural shaders know. */
#ifndef NOISES_H
#define NOISES_H

#include "filterwidth.h"

/* noise from -1 to 1 instead of from 0 to 1 */
#ifndef snoise
#define snoise(x) (2 * (float noise(x)) - 1)
#endif
#ifndef snoise2
#define snoise2(x, y) (2 * (float noise(x, y)) - 1)
#endif
#ifndef snoisexy
#define snoisexy(x, y) (2 * (float noise(x, y)) - 1)
#endif
#ifndef snoisept
#define snoisept(p, t) (2 * (float noise(p, t)) - 1)
#endif
#ifndef vsnoise
#define vsnoise(x) (2 * (vector noise(x)) - 1)
#endif
#ifndef vsnoisept
#define vsnoisept(p, t) (2 * (vector noise(p, t)) - 1)
#endif
#ifndef psnoise
#define psnoise(x, w) (2 * pnoise(x, w) - 1)
#endif
#ifndef fadeout
/* gives way to its average as a feature becomes smaller than a sample */
#define fadeout(g, average, size, width) mix((g), (average), smoothstep(.2, .6, (width) / (size)))
#endif

/* noise from -1 to 1 that vanishes where a sample is larger than its features */
#ifndef filteredsnoise
#define filteredsnoise(p, width) (snoise(p) * (1 - smoothstep(0.2, 0.75, width)))
#endif
#ifndef filteredvsnoise
#define filteredvsnoise(p, width) (vsnoise(p) * (1 - smoothstep(0.2, 0.75, width)))
#endif

/* fractional Brownian motion: octaves, each lacunarity times finer and gain times weaker */
float fBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float octave, weight = 1;
    float total = 0, width = filtwidth;
    point at = p;
    for (octave = 0; octave < maxoctaves; octave += 1) {
        total += weight * filteredsnoise(at, width);
        weight *= gain;
        at *= lacunarity;
        width *= lacunarity;
    }
    return total;
}
vector vfBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float octave, weight = 1;
    float width = filtwidth;
    vector total = 0;
    point at = p;
    for (octave = 0; octave < maxoctaves; octave += 1) {
        total += weight * filteredvsnoise(at, width);
        weight *= gain;
        at *= lacunarity;
        width *= lacunarity;
    }
    return total;
}
/* the same under its older name */
float filtered_fBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    return fBm(p, filtwidth, maxoctaves, lacunarity, gain);
}
#ifndef filtered_fBm_default
#define filtered_fBm_default(p) filtered_fBm((p), filterwidthp(p), 4, 2, 0.5)
#endif
#ifndef fBm_default
#define fBm_default(p) fBm((p), filterwidthp(p), 4, 2, 0.5)
#endif
#ifndef vfBm_default
#define vfBm_default(p) vfBm((p), filterwidthp(p), 4, 2, 0.5)
#endif

/* the same sum of absolute values: creases where noise passes zero */
float turbulence(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain)
{
    uniform float octave, weight = 1;
    float total = 0, width = filtwidth;
    point at = p;
    for (octave = 0; octave < maxoctaves; octave += 1) {
        total += weight * abs(filteredsnoise(at, width));
        weight *= gain;
        at *= lacunarity;
        width *= lacunarity;
    }
    return total;
}
float turbulence(point p; uniform float octaves, lacunarity, gain)
{
    return turbulence(p, filterwidthp(p), octaves, lacunarity, gain);
}
float turbulence(point p; float octaves)
{
    float k, weight = 1, total = 0;
    for (k = 0; k < octaves; k += 1) {
        total += abs(2 * float noise(p / weight) - 1) * weight;
        weight *= 0.5;
    }
    return total;
}
#ifndef turbulence_default
#define turbulence_default(p) turbulence((p), filterwidthp(p), 4, 2, 0.5)
#endif
float fBm(point p; uniform float octaves, lacunarity, gain) { return fBm(p, filterwidthp(p), octaves, lacunarity, gain); }

/* noise at a place that noise has moved */
#ifndef VLNoise
#define VLNoise(p, scale) snoise((p) + (scale) * vsnoise(p))
#endif
#ifndef filteredVLNoise
#define filteredVLNoise(p, filtwidth, scale) filteredsnoise((p) + filteredvsnoise(p, filtwidth) * (scale), filtwidth)
#endif
float VLfBm(point p; float filtwidth; uniform float maxoctaves, lacunarity, gain, scale)
{
    uniform float octave, weight = 1;
    float total = 0, width = filtwidth;
    point at = p;
    for (octave = 0; octave < maxoctaves; octave += 1) {
        total += weight * filteredVLNoise(at, width, scale);
        weight *= gain;
        at *= lacunarity;
        width *= lacunarity;
    }
    return total;
}
#ifndef VLfBm_default
#define VLfBm_default(p) VLfBm((p), filterwidthp(p), 4, 2, 0.5, 1.0)
#endif

/* cellular patterns: distances to the nearest (and second nearest) of points scattered one a cell */
void voronoi_f1f2_2d(float ss, tt, jitter; output float f1; output float spos1, tpos1; output float f2; output float spos2, tpos2)
{
    float cs = floor(ss) + 0.5, ct = floor(tt) + 0.5;
    uniform float i, j;
    f1 = 1000;
    f2 = 1000;
    for (i = -1; i <= 1; i += 1) {
        float sc = cs + i;
        for (j = -1; j <= 1; j += 1) {
            float tc = ct + j;
            float sp = sc + jitter * (float cellnoise(sc, tc) - 0.5);
            float tp = tc + jitter * (float cellnoise(sc + 1000, tc) - 0.5);
            float d = (sp - ss) * (sp - ss) + (tp - tt) * (tp - tt);
            if (d < f1) {
                f2 = f1; spos2 = spos1; tpos2 = tpos1;
                f1 = d; spos1 = sp; tpos1 = tp;
            } else if (d < f2) {
                f2 = d; spos2 = sp; tpos2 = tp;
            }
        }
    }
    f1 = sqrt(f1);
    f2 = sqrt(f2);
}
void voronoi_f1_2d(float ss, tt, jitter; output float f1; output float spos1, tpos1)
{
    float f2 = 0, sp = 0, tp = 0;
    voronoi_f1f2_2d(ss, tt, jitter, f1, spos1, tpos1, f2, sp, tp);
}
void voronoi_f1f2_3d(point P; float jitter; output float f1; output point pos1; output float f2; output point pos2)
{
    point home = point(floor(xcomp(P)) + 0.5, floor(ycomp(P)) + 0.5, floor(zcomp(P)) + 0.5);
    uniform float i, j, k;
    f1 = 1000;
    f2 = 1000;
    for (i = -1; i <= 1; i += 1)
        for (j = -1; j <= 1; j += 1)
            for (k = -1; k <= 1; k += 1) {
                point cell = home + vector(i, j, k);
                point at = cell + jitter * (vector cellnoise(cell) - 0.5);
                vector to = at - P;
                float d = to . to;
                if (d < f1) {
                    f2 = f1; pos2 = pos1;
                    f1 = d; pos1 = at;
                } else if (d < f2) {
                    f2 = d; pos2 = at;
                }
            }
    f1 = sqrt(f1);
    f2 = sqrt(f2);
}
void voronoi_f1_3d(point P; float jitter; output float f1; output point pos1)
{
    float f2 = 0;
    point pos2 = point(0);
    voronoi_f1f2_3d(P, jitter, f1, pos1, f2, pos2);
}
#endif

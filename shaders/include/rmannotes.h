/* The helpers of the layered style: repeat, rotate, pulse, blend. */
#ifndef RMANNOTES_H
#define RMANNOTES_H

#include "patterns.h"

#ifndef snoise
#define snoise(x) (2 * noise(x) - 1)
#endif
#ifndef snoise2
#define snoise2(x, y) (2 * noise(x, y) - 1)
#endif
#ifndef snoisep
#define snoisep(p) (2 * (point noise(p)) - point(1, 1, 1))
#endif
#ifndef nhash
#define nhash(x) (2 * noise(x) - 1)
#endif

/* coordinates within a tile, and the tile's number */
#ifndef repeat
#define repeat(x, freq) (mod((x) * (freq), 1.0))
#endif
#ifndef whichtile
#define whichtile(x, freq) (floor((x) * (freq)))
#endif
#ifndef odd
#define odd(x) (mod((x), 2) == 1)
#endif
#ifndef even
#define even(x) (mod((x), 2) == 0)
#endif

/* uniformly distributed numbers and their bands, from a seed */
#ifndef udn
#define udn(x, lo, hi) (smoothstep(.25, .75, noise(x)) * ((hi) - (lo)) + (lo))
#endif
#ifndef udn2
#define udn2(x, y, lo, hi) (smoothstep(.25, .75, noise(x, y)) * ((hi) - (lo)) + (lo))
#endif

/* turn (x, y) about (ox, oy) by an angle in radians */
void rotate2d(float x, y, rad, ox, oy; output float rx, ry)
{
    float dx = x - ox, dy = y - oy, c = cos(rad), n = sin(rad);
    rx = dx * c - dy * n + ox;
    ry = dx * n + dy * c + oy;
}
/* polar coordinates about the middle of the unit square, angle from 0 to 1 */
void topolar2d(float x, y; output float r, a)
{
    r = sqrt((x - .5) * (x - .5) + (y - .5) * (y - .5));
    a = (atan(y - .5, x - .5) + PI) / (2 * PI);
}
void topolar(float x, y; output float r, a)
{
    r = sqrt(x * x + y * y);
    a = atan(y, x);
}
void tocartesian(float r, a; output float x, y)
{
    x = r * cos(a);
    y = r * sin(a);
}
/* the same about a middle: what stands left of a comma in old files */
void radial(float x, y; output float r, a) { topolar2d(x, y, r, a); }

float intersect(float a, b) { return min(a, b); }
/* distance from a line through two points in the plane of s and t */
float line(float x, y, x0, y0, x1, y1, width, fuzz)
{
    float d = ptlined(point(x0, y0, 0), point(x1, y1, 0), point(x, y, 0));
    return 1 - smoothstep(width / 2 - fuzz, width / 2, d);
}
float pnoise2(float x, y) { return 2 * float noise(x, y) - 1; }

float fractalsum(point p)
{
    float k, total = 0;
    for (k = 1; k < 512; k *= 2) total += abs(.5 - float noise(p * k)) / k;
    return total;
}
/* curves from 0 to 1 through (0.5, b), and steeper or flatter about the middle */
float bias(float t, b) { return pow(t, -log(b) / log(2)); }
float gain(float t, g) { return t < .5 ? bias(2 * t, 1 - g) / 2 : 1 - bias(2 - 2 * t, 1 - g) / 2; }
#endif

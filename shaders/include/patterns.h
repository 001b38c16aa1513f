/* Steps, pulses and trains of pulses, sharp or filtered over the width of a sample. */
#ifndef PATTERNS_H
#define PATTERNS_H

#include "filterwidth.h"

#ifndef blend
#define blend(a, b, x) ((a) * (1 - (x)) + (b) * (x))
#endif
#ifndef union
#define union(a, b) ((a) + (b) - (a) * (b))
#endif
#ifndef intersection
#define intersection(a, b) ((a) * (b))
#endif
#ifndef difference
#define difference(a, b) ((a) * (1 - (b)))
#endif
#ifndef complement
#define complement(a) (1 - (a))
#endif
#ifndef boxstep
#define boxstep(a, b, x) (clamp(((x) - (a)) / ((b) - (a)), 0, 1))
#endif
float sqr(float x) { return x * x; }

/* 1 between the edges; with a fourth value smooth over fuzz */
float pulse(float a, b, fuzz, x) { return smoothstep(a - fuzz, a, x) - smoothstep(b - fuzz, b, x); }
float pulse(float a, b, x) { return step(a, x) - step(b, x); }
/* 0 in the first `edge` of each period, 1 in the rest */
float pulsetrain(float edge, period, x) { return pulse(edge, period, mod(x, period)); }
float smoothpulse(float e0, e1, e2, e3, x) { return smoothstep(e0, e1, x) - smoothstep(e2, e3, x); }
float smoothpulsetrain(float e0, e1, e2, e3, period, x) { return smoothpulse(e0, e1, e2, e3, mod(x, period)); }

float filteredpulse(float edge0, edge1, x, dx)
{
    float x0 = x - dx / 2, x1 = x + dx / 2;
    return max(0, (min(x1, edge1) - max(x0, edge0)) / dx);
}
/* the same, averaged over dx around x */
float filteredpulsetrain(float edge, period, x, dx)
{
    float w = dx / period, x0 = x / period - w / 2, x1 = x0 + w, low = edge / period;
    float ones = ((1 - low) * floor(x1) + max(0, x1 - floor(x1) - low)) - ((1 - low) * floor(x0) + max(0, x0 - floor(x0) - low));
    return ones / w;
}
/* integral of smoothstep(e0, e1, .) up to x */
float smoothstepintegral(float e0, e1, x)
{
    float width = e1 - e0, r = clamp((x - e0) / width, 0, 1);
    return width * (r * r * r - 0.5 * r * r * r * r) + max(0, x - e1);
}
float filteredsmoothstep(float e0, e1, x, dx)
{
    return (smoothstepintegral(e0, e1, x + dx / 2) - smoothstepintegral(e0, e1, x - dx / 2)) / dx;
}
float filteredsmoothpulse(float e0, e1, e2, e3, x, dx)
{
    return filteredsmoothstep(e0, e1, x, dx) - filteredsmoothstep(e2, e3, x, dx);
}
/* average of |x| over dx */
float filteredabs(float x, dx)
{
    float x0 = x - dx / 2, x1 = x + dx / 2;
    return (x1 * abs(x1) - x0 * abs(x0)) / (2 * dx);
}

/* running bond: which brick, where in it, and is it brick or mortar? Sizes in the units of s and t. */
float brick(float ss, tt, width, height, mortar, stagger; output float row, column, x, y)
{
    float w = width + mortar, h = height + mortar;
    row = floor(tt / h);
    float shifted = ss / w + stagger * mod(row, 2);
    column = floor(shifted);
    x = (shifted - column) * w;
    y = tt - row * h;
    return pulse(mortar / 2, w - mortar / 2, x) * pulse(mortar / 2, h - mortar / 2, y);
}
/* Tiles of a running bond: which column and row, and where in the tile, 0 to 1. rowstagger: shift of each row against the one before, and how
   much it varies; jagged: noise on the edges. */
void basictile(float x, y; uniform float tilewidth, tileheight; uniform float rowstagger, rowstaggervary; uniform float jaggedfreq, jaggedamp;
               output float column, row; output float xtile, ytile)
{
    point bent = 0;
    if (jaggedamp != 0) bent = jaggedamp * point noise(x * jaggedfreq / tilewidth, y * jaggedfreq / tileheight);
    float across = (x + xcomp(bent)) / tilewidth, up = (y + ycomp(bent)) / tileheight;
    row = floor(up);
    across += mod(rowstagger * row, 1) + rowstaggervary * (float noise(row + 0.5) - 0.5);
    column = floor(across);
    xtile = across - column;
    ytile = up - row;
}
void basicbrick(float x, y; uniform float tilewidth, tileheight; uniform float rowstagger, rowstaggervary; uniform float jaggedfreq, jaggedamp;
                output float column, row; output float xtile, ytile)
{
    basictile(x, y, tilewidth, tileheight, rowstagger, rowstaggervary, jaggedfreq, jaggedamp, column, row, xtile, ytile);
}
/* Square tiles one unit wide: which, where in it, and 1 on the tile, 0 in the groove; filtered over ds and dt. */
float tilepattern(float ss, tt, ds, dt; float groovewidth, grooveheight; output float swhichtile, twhichtile; output float stile, ttile)
{
    swhichtile = floor(ss);
    twhichtile = floor(tt);
    stile = ss - swhichtile;
    ttile = tt - twhichtile;
    return filteredpulsetrain(groovewidth, 1, ss + groovewidth / 2, ds) * filteredpulsetrain(grooveheight, 1, tt + grooveheight / 2, dt);
}
/* A colour a little other than Cin, by an index: hue, saturation and luminance each vary by so much. */
color varyEach(color Cin; float index, varyhue, varysat, varylum)
{
    color hsl = ctransform("rgb", "hsl", Cin);
    float h = comp(hsl, 0) + varyhue * (float cellnoise(index + 3) - 0.5);
    float k = comp(hsl, 1) * (1 - varysat * (float cellnoise(index - 14) - 0.5));
    float l = comp(hsl, 2) * (1 - varylum * (float cellnoise(index + 37) - 0.5));
    return ctransform("hsl", "rgb", color(mod(h, 1), clamp(k, 0, 1), clamp(l, 0, 1)));
}
#endif

/* What patterns of RIS have in common. A pattern is a surface shader whose outputs parameters of others take (docs/ris.md). */
#ifndef RISPATTERN_H
#define RISPATTERN_H

/* The members of a struct manifold that a pattern takes from the one that is connected; manifold_given is 1 then. */
#define RIS_MANIFOLD varying point manifold_Q = 0; varying float manifold_Qradius = 0; varying float manifold_given = 0
/* Coordinates (x, y) of the manifold, or s and t with t upwards. */
#define RIS_COORDINATES(x, y) \
    float x = (manifold_given > .5) ? xcomp(manifold_Q) : s, y = (manifold_given > .5) ? ycomp(manifold_Q) : t
/* A place: that of the manifold, else in object space. */
#define RIS_PLACE(q) point q = (manifold_given > .5) ? manifold_Q : transform("object", P)
/* Outputs that are a colour, also channel by channel. */
#define RIS_RGB output varying color resultRGB = 0; output varying float resultR = 0, resultG = 0, resultB = 0
#define RIS_CHANNELS resultR = comp(resultRGB, 0); resultG = comp(resultRGB, 1); resultB = comp(resultRGB, 2);
/* What a manifold gives. */
#define RIS_RESULT output varying point result_Q = 0; output varying float result_Qradius = 0; output varying float result_given = 1

/* 1 where the fraction of x is below one half, filtered over what x changes by across the footprint. */
float risWave(float x;) {
    float integral(float v;) { float f = floor(v); return .5 * f + min(v - f, .5); }
    float w = max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6);
    return clamp((integral(x + w / 2) - integral(x - w / 2)) / w, 0, 1);
}

float risLuminance(color c;) { return .2126 * comp(c, 0) + .7152 * comp(c, 1) + .0722 * comp(c, 2); }

/* x of a channel brought from [low, high] to [0, 1]. */
float risUnit(float x, low, high;) { return (high == low) ? 0 : (x - low) / (high - low); }

/* Perlin's bias and gain. */
float risBias(float x, b;) { return (x <= 0) ? 0 : pow(x, log(clamp(b, 1e-3, .999)) / log(.5)); }
float risGain(float x, g;) { return (x < .5) ? risBias(2 * x, 1 - g) / 2 : 1 - risBias(2 - 2 * x, 1 - g) / 2; }

color risSaturate(color c; float s;) { return mix(color(risLuminance(c)), c, color(s)); }
color risPower(color c, e;) {
    return color(pow(max(0, comp(c, 0)), comp(e, 0)), pow(max(0, comp(c, 1)), comp(e, 1)), pow(max(0, comp(c, 2)), comp(e, 2)));
}
/* A colour with its hue turned by so many degrees, and saturation and value (or lightness) scaled in the space. */
color risAdjust(string space; color c; float turn, s, v;) {
    color h = ctransform("rgb", space, c);
    return ctransform(space, "rgb", color(mod(comp(h, 0) + turn / 360, 1), clamp(comp(h, 1) * s, 0, 1), comp(h, 2) * v));
}
#endif

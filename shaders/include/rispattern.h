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
/* Three places on pictures, which picture each is of, and how much each counts (1 in all): what PxrMultiTexture takes. id: a random number. */
#define RIS_MULTI varying point manifoldMulti_Q0 = 0, manifoldMulti_Q1 = 0, manifoldMulti_Q2 = 0; \
    varying vector manifoldMulti_index = 0, manifoldMulti_weight = 0; varying float manifoldMulti_id = 0, manifoldMulti_given = 0
#define RIS_RESULT_MULTI output varying point resultMulti_Q0 = 0, resultMulti_Q1 = 0, resultMulti_Q2 = 0; \
    output varying vector resultMulti_index = 0, resultMulti_weight = 0; output varying float resultMulti_id = 0, resultMulti_given = 1
/* Outputs that are a vector, also component by component. */
#define RIS_XYZ output varying vector resultXYZ = 0; output varying float resultX = 0, resultY = 0, resultZ = 0
#define RIS_COMPONENTS resultX = xcomp(resultXYZ); resultY = ycomp(resultXYZ); resultZ = zcomp(resultXYZ);

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
/* A channel of one colour, a, over another, b: the operations of PxrBlend. */
float risBlend(float op, a, b;) {
    return (op == 0) ? a + b : (op == 1) ? a * b : (op == 2) ? 1 - (1 - a) * (1 - b)
         : (op == 3) ? ((b < .5) ? 2 * a * b : 1 - 2 * (1 - a) * (1 - b)) : (op == 4) ? (1 - 2 * a) * b * b + 2 * a * b
         : (op == 5) ? ((a < .5) ? 2 * a * b : 1 - 2 * (1 - a) * (1 - b)) : (op == 6) ? ((a >= 1) ? 1 : min(1, b / max(1 - a, 1e-6)))
         : (op == 7) ? ((a <= 0) ? 0 : 1 - min(1, (1 - b) / max(a, 1e-6))) : (op == 8) ? min(a, b) : (op == 9) ? max(a, b)
         : (op == 10) ? abs(a - b) : (op == 11) ? a + b - 2 * a * b : (op == 12) ? b - a : (op == 13) ? b / max(a, 1e-6)
         : (op == 15) ? (a + b) / 2 : a;
}
color risBlended(float op; color a, b;) { return color(risBlend(op, comp(a, 0), comp(b, 0)), risBlend(op, comp(a, 1), comp(b, 1)), risBlend(op, comp(a, 2), comp(b, 2))); }

/* The k-th random number, 0 to 1, that belongs to x. */
float risRandom(float x, k;) { return cellnoise(1.37 * x + .5, k + .5); }
/* What tells objects apart: source 0 Attribute "identifier" "id", 1 its name; 0 where the object has none. */
float risObject(uniform float source;) {
    uniform float number = 0;
    uniform string name = "";
    float id = 0;
    if (source == 1) {
        attribute("identifier:name", name);
        if (name != "") id = stringhash(name);
    } else {
        attribute("identifier:id", number);
        id = number;
    }
    return id;
}
/* A step by at most `limit`: mode 0 about nothing, 1 up, 2 down; r from 0 to 1. */
float risStep(float limit, mode, r;) { return limit * ((mode == 1) ? r : (mode == 2) ? -r : r - .5); }
/* A colour with hue, saturation, luminance and gamma changed by random steps of those limits, of the object x. */
color risVaried(color c; float x, hue, saturation, luminance_, gamma_, hueMode, saturationMode, luminanceMode, gammaMode;) {
    color h = ctransform("rgb", "hsl", c);
    h = color(mod(comp(h, 0) + risStep(hue, hueMode, risRandom(x, 1)), 1),
              clamp(comp(h, 1) * (1 + risStep(saturation, saturationMode, risRandom(x, 2))), 0, 1),
              max(comp(h, 2) * (1 + risStep(luminance_, luminanceMode, risRandom(x, 3))), 0));
    float g = 1 / max(1 + risStep(gamma_, gammaMode, risRandom(x, 4)), .01);
    return risPower(ctransform("hsl", "rgb", h), color(g));
}
#endif

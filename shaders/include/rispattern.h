/* What patterns of RIS have in common. A pattern is a surface shader whose outputs parameters of others take (docs/ris.md). */
#ifndef RISPATTERN_H
#define RISPATTERN_H

/* The members of a struct manifold that a pattern takes; manifold_given is 1 where one is connected. */
#define RIS_MANIFOLD varying point manifold_Q = 0; varying float manifold_Qradius = 0; varying float manifold_given = 0
/* Coordinates (x, y) of the manifold, or s and t with t upwards. */
#define RIS_COORDINATES(x, y) float x = (manifold_given > .5) ? xcomp(manifold_Q) : s, y = (manifold_given > .5) ? ycomp(manifold_Q) : t
#define RIS_CHANNELS(c) resultR = comp(c, 0); resultG = comp(c, 1); resultB = comp(c, 2);

/* 1 where the fraction of x is below one half, filtered over what x changes by across the footprint. */
float risWave(float x;) {
    float w = max(abs(Du(x) * du) + abs(Dv(x) * dv), 1e-6);
    float integral(float v;) { float f = floor(v); return .5 * f + min(v - f, .5); }
    return clamp((integral(x + w / 2) - integral(x - w / 2)) / w, 0, 1);
}
#endif

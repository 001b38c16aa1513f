/* PxrCurvature: edges and corners found by rays, of RIS: convexTint where rays that go inward soon leave the body again, concaveTint where those that go outward soon meet something, black where it is flat. numSamples
   rays of each kind, at most maxDistance long (0: without end); distribution 0 uniform, 1 cosine over a cone as wide as cosineSpread says. bias: how much a hit at the distance d counts, 1 - d / maxDistance (1 - bias) / bias:
   1 all alike, .5 less and less down to none, near 0 only the nearest. traceSet: groups of objects that count. A material with it waits for rays. Pixar's manual gives no formula; names of tints are ours. */
#include "rispattern.h"
surface PxrCurvature(float numSamples = 4, maxDistance = 0; string traceSet = ""; float distribution = 1, cosineSpread = 1, bias = .5; varying color convexTint = 1, concaveTint = 0;
                     RIS_RGB; output varying float resultConvex = 0, resultConcave = 0) {
    uniform float width = PI / 2 * clamp(cosineSpread, 1e-3, 1), rays = clamp(numSamples, 1, 4096), b = clamp(bias, 1e-3, 1);
    uniform string spread = (distribution == 0) ? "uniform" : "cosine";
    /* The weight is one of hits that all count up to maxDistance, and one that falls to 0 at far. */
    uniform float falling = (maxDistance > 0) ? min((1 - b) / b, 1) : 0, far = (maxDistance > 0) ? maxDistance * min(b / (1 - min(b, .5)), 1) : 1e30;
    vector outside = vector faceforward(normalize(N), I);
    float near(vector axis;) {
        float even = 0, less = 0;
        if (falling < 1) even = occlusion(P, axis, rays, "maxdist", far, "coneangle", width, "distribution", spread, "subset", traceSet, "hitsides", "both");
        if (falling > 0) less = occlusion(P, axis, rays, "maxdist", far, "coneangle", width, "distribution", spread, "subset", traceSet, "hitsides", "both", "falloffmode", 1, "falloff", 1);
        return (1 - falling) * even + falling * less;
    }
    resultConvex = near(-outside);
    resultConcave = near(outside);
    resultRGB = resultConvex * convexTint + resultConcave * concaveTint;
    RIS_CHANNELS
}

/* PxrDirt: how much of what lies around a point is near, of RIS: unoccluded where nothing is, occluded where all is blocked up to maxDistance (0: however far). numSamples rays; distribution 0 uniform,
   1 cosine over a cone as wide as cosineSpread says (1: all of the hemisphere). falloff above 0: hits count less the farther they are, (1 - d / maxDistance)^falloff, without a maxDistance exp(-falloff d);
   below 0 all count. direction 0 outside, 1 inside, 2 both; biasDirection (of biasDirectionCoordsys) bends the axis. traceSet: groups of objects that count. A material with it waits for rays. */
#include "rispattern.h"
surface PxrDirt(varying color occluded = 1, unoccluded = 0; float numSamples = 4, distribution = 1, cosineSpread = 1, falloff = 0, maxDistance = 0, direction = 0; varying vector biasDirection = 0;
                string biasDirectionCoordsys = "object", traceSet = ""; RIS_RGB) {
    uniform float far = (maxDistance > 0) ? maxDistance : 1e30, width = PI / 2 * clamp(cosineSpread, 1e-3, 1), rays = clamp(numSamples, 1, 4096);
    normal outside = faceforward(normalize(N), I);
    vector lean = vtransform((biasDirectionCoordsys == "") ? "object" : biasDirectionCoordsys, "current", biasDirection);
    float near(vector axis;) {
        return occlusion(P, axis, rays, "maxdist", far, "coneangle", width, "distribution", (distribution == 0) ? "uniform" : "cosine", "subset", traceSet, "hitsides", "both",
                         "falloffmode", (maxDistance > 0) ? 1 : 0, "falloff", max(falloff, 0));
    }
    float part = 0;
    if (direction != 1) part += near(normalize(vector outside + lean));
    if (direction != 0) part += near(normalize(lean - vector outside));
    if (direction != 0 && direction != 1) part /= 2;
    resultRGB = mix(unoccluded, occluded, color(part));
    RIS_CHANNELS
}

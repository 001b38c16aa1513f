/* PxrChecker: squares of two colours, of RIS, filtered by the footprint: two by two over one unit of s and t, or of a manifold.
   dimensions 3 makes cubes of a manifold of places. */
#include "rispattern.h"
surface PxrChecker(varying color colorA = 1; varying color colorB = 0; float dimensions = 2; RIS_MANIFOLD; RIS_RGB) {
    RIS_COORDINATES(x, y);
    float a = risWave(x), b = risWave(y);
    float same = a * b + (1 - a) * (1 - b);
    if (dimensions == 3) {
        float c = risWave(zcomp(manifold_Q));
        same = same * c + (1 - same) * (1 - c);
    }
    resultRGB = mix(colorB, colorA, color(same));
    RIS_CHANNELS
}

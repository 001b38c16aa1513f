/* PxrChecker: squares of two colours, of RIS, filtered by the footprint. Outputs resultRGB, resultR. A manifold (PxrManifold2D) or s and t,
   whose whole numbers are eight squares apart, are the coordinates. */
#include "rispattern.h"
surface PxrChecker(varying color colorA = 0; varying color colorB = 1; RIS_MANIFOLD; output varying color resultRGB = 0; output varying float resultR = 0, resultG = 0, resultB = 0) {
    RIS_COORDINATES(x, y);
    float a = risWave(x * 4), b = risWave(y * 4);
    float same = a * b + (1 - a) * (1 - b);
    resultRGB = mix(colorB, colorA, color(same));
    RIS_CHANNELS(resultRGB)
}

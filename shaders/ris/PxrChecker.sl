/* PxrChecker: squares of two colours, of RIS, filtered by the footprint: eight by eight over s and t, or over one unit of a manifold. */
#include "rispattern.h"
surface PxrChecker(varying color colorA = 0; varying color colorB = 1; RIS_MANIFOLD; RIS_RGB) {
    RIS_COORDINATES(x, y);
    float a = risWave(x * 4), b = risWave(y * 4);
    resultRGB = mix(colorB, colorA, color(a * b + (1 - a) * (1 - b)));
    RIS_CHANNELS
}

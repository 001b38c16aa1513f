/* PxrRamp: colours along t (rampType 0), s (1), a diagonal (2), about or away from the middle (3 circular, 4 radial), of RIS; linear or smooth between them. positions and colors in the
   order of their positions; splineMap, or colorRamp of that many knots. Not done: tile, reverse and randomness of later versions. */
#include "rispattern.h"
surface PxrRamp(float rampType = 0; float colorRamp = 0; float colorRamp_Knots[] = {}; color colorRamp_Colors[] = {}; float positions[] = {}; color colors[] = {}; string colorRamp_Interpolation = "linear"; varying float splineMap = -1;
                RIS_MANIFOLD; RIS_RGB; output varying float resultF = 0) {
    RIS_COORDINATES(x, y);
    float k = (rampType == 1) ? x : (rampType == 2) ? (x + y) / 2 : (rampType == 3) ? atan(y - .5, x - .5) / (2 * PI) + .5
            : (rampType == 4) ? 2 * sqrt((x - .5) * (x - .5) + (y - .5) * (y - .5)) : y;
    if (splineMap >= 0) k = splineMap;
    float n = arraylength(colorRamp_Knots), m = arraylength(positions), i;
    resultRGB = k;
    if (n > 0) {
        resultRGB = colorRamp_Colors[0];
        for (i = 1; i < n; i += 1) {
            float f = clamp((k - colorRamp_Knots[i - 1]) / max(colorRamp_Knots[i] - colorRamp_Knots[i - 1], 1e-6), 0, 1);
            resultRGB = mix(resultRGB, colorRamp_Colors[i], color(f));
        }
    } else if (m > 0) {
        resultRGB = colors[0];
        for (i = 1; i < m; i += 1) {
            float f = clamp((k - positions[i - 1]) / max(positions[i] - positions[i - 1], 1e-6), 0, 1);
            resultRGB = mix(resultRGB, colors[i], color(f));
        }
    }
    resultF = risLuminance(resultRGB);
    RIS_CHANNELS
}

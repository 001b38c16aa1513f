/* PxrBlend: one colour over another by an operation, of RIS. operation: 0 add, 1 multiply, 2 screen, 3 overlay, 4 soft light, 5 hard light, 6 dodge, 7 burn, 8 darken,
   9 lighten, 10 difference, 11 exclusion, 12 subtract, 13 divide, 14 replace, 15 average, 16 none, 17 exclude bottom, 18 over; weighed by topA. Those beyond are over. */
#include "rispattern.h"
surface PxrBlend(float operation = 18; varying color topRGB = 0; varying float topA = 1; varying color bottomRGB = 0; varying float bottomA = 1; float clampOutput = 0;
                 RIS_RGB; output varying float resultA = 1) {
    color c = risBlended(operation, topRGB, bottomRGB);
    resultRGB = (operation == 16) ? bottomRGB : mix(bottomRGB, c, color(topA));
    resultA = topA + bottomA * (1 - topA);
    if (clampOutput != 0) resultRGB = clamp(resultRGB, color(0), color(1));
    RIS_CHANNELS
}

/* PxrBlend: one colour over another by an operation, of RIS. operation: 0 add, 1 multiply, 2 screen, 3 overlay, 4 soft light, 5 hard light, 6 dodge, 7 burn, 8 darken,
   9 lighten, 10 difference, 11 exclusion, 12 subtract, 13 divide, 14 replace, 15 average, 16 none, 17 exclude bottom, 18 over; weighed by topA. Those beyond are over. */
#include "rispattern.h"
surface PxrBlend(float operation = 18; varying color topRGB = 0; varying float topA = 1; varying color bottomRGB = 0; varying float bottomA = 1; float clampOutput = 0;
                 RIS_RGB; output varying float resultA = 1) {
    float one(float op, a, b;) {
        return (op == 0) ? a + b : (op == 1) ? a * b : (op == 2) ? 1 - (1 - a) * (1 - b)
             : (op == 3) ? ((b < .5) ? 2 * a * b : 1 - 2 * (1 - a) * (1 - b)) : (op == 4) ? (1 - 2 * a) * b * b + 2 * a * b
             : (op == 5) ? ((a < .5) ? 2 * a * b : 1 - 2 * (1 - a) * (1 - b)) : (op == 6) ? ((a >= 1) ? 1 : min(1, b / max(1 - a, 1e-6)))
             : (op == 7) ? ((a <= 0) ? 0 : 1 - min(1, (1 - b) / max(a, 1e-6))) : (op == 8) ? min(a, b) : (op == 9) ? max(a, b)
             : (op == 10) ? abs(a - b) : (op == 11) ? a + b - 2 * a * b : (op == 12) ? b - a : (op == 13) ? b / max(a, 1e-6)
             : (op == 15) ? (a + b) / 2 : a;
    }
    color c = color(one(operation, comp(topRGB, 0), comp(bottomRGB, 0)), one(operation, comp(topRGB, 1), comp(bottomRGB, 1)), one(operation, comp(topRGB, 2), comp(bottomRGB, 2)));
    resultRGB = (operation == 16) ? bottomRGB : mix(bottomRGB, c, color(topA));
    resultA = topA + bottomA * (1 - topA);
    if (clampOutput != 0) resultRGB = clamp(resultRGB, color(0), color(1));
    RIS_CHANNELS
}

/* PxrArithmetic: two colours put together channel by channel, of RIS: operation 0 adds, 1 multiplies, 2 subtracts, 3 divides (by 0: 0), 4 and 5 take the smaller and the larger, 6 raises input1
   (0 where it is below) to input2, 7 is the rest of a division; others hand input1 on. No manual gives these numbers; published scenes multiply by 1. */
#include "rispattern.h"
surface PxrArithmetic(float operation = 0; varying color input1 = 0, input2 = 0; RIS_RGB) {
    float put(float a, b;) {
        return (operation == 0) ? a + b : (operation == 1) ? a * b : (operation == 2) ? a - b : (operation == 3) ? ((b == 0) ? 0 : a / b)
             : (operation == 4) ? min(a, b) : (operation == 5) ? max(a, b) : (operation == 6) ? pow(max(a, 0), b)
             : (operation == 7) ? ((b == 0) ? 0 : mod(a, b)) : a;
    }
    resultRGB = color(put(comp(input1, 0), comp(input2, 0)), put(comp(input1, 1), comp(input2, 1)), put(comp(input1, 2), comp(input2, 2)));
    RIS_CHANNELS
}

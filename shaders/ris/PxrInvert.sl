/* PxrInvert: one minus a colour, of RIS; where invertChannel0, 1 or 2 is 0 that channel stays. Not done: other colour models. */
#include "rispattern.h"
surface PxrInvert(varying color inputRGB = 0; float colorModel = 0, invertChannel0 = 1, invertChannel1 = 1, invertChannel2 = 1; RIS_RGB) {
    resultRGB = color((invertChannel0 != 0) ? 1 - comp(inputRGB, 0) : comp(inputRGB, 0), (invertChannel1 != 0) ? 1 - comp(inputRGB, 1) : comp(inputRGB, 1), (invertChannel2 != 0) ? 1 - comp(inputRGB, 2) : comp(inputRGB, 2));
    RIS_CHANNELS
}

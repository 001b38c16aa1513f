/* PxrInvert: one minus a colour, of RIS; where invertColorChannel0, 1 or 2 is 0 that channel stays. Not done: other colour models. */
#include "rispattern.h"
surface PxrInvert(varying color inputRGB = 0; float colorModel = 0, invertColorChannel0 = 1, invertColorChannel1 = 1, invertColorChannel2 = 1; RIS_RGB) {
    resultRGB = color((invertColorChannel0 != 0) ? 1 - comp(inputRGB, 0) : comp(inputRGB, 0), (invertColorChannel1 != 0) ? 1 - comp(inputRGB, 1) : comp(inputRGB, 1), (invertColorChannel2 != 0) ? 1 - comp(inputRGB, 2) : comp(inputRGB, 2));
    RIS_CHANNELS
}

/* PxrSwitch: one of the colours inputsRGB, of RIS: the first for an index up to .5, the second up to 1.5, and so on, over again beyond the last. */
#include "rispattern.h"
surface PxrSwitch(varying float index = 0; varying color inputsRGB[] = {}; RIS_RGB) {
    uniform float n = arraylength(inputsRGB), i;
    float which = mod(floor(index + .5), max(n, 1));
    for (i = 0; i < n; i += 1)
        if (i == which) resultRGB = inputsRGB[i];
    RIS_CHANNELS
}

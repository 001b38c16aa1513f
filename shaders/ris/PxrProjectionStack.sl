/* PxrProjectionStack: layers (PxrProjectionLayer) one over the other, of RIS, the first below: their colours layersRGB count by layersA, layersMode 0 leaves a layer out. resultA: what they cover.
   Not done: other modes, channels. */
#include "rispattern.h"
surface PxrProjectionStack(float layersMode[] = {}; varying color layersRGB[] = {}; varying float layersA[] = {}; RIS_RGB; output varying float resultA = 0) {
    uniform float n = arraylength(layersRGB), modes = arraylength(layersMode), alphas = arraylength(layersA), i;
    for (i = 0; i < n; i += 1) {
        float on = 1, a = 1;
        if (i < modes) on = (layersMode[i] == 0) ? 0 : 1;
        if (i < alphas) a = clamp(layersA[i], 0, 1);
        a *= on;
        resultRGB = mix(resultRGB, layersRGB[i], color(a));
        resultA = a + resultA * (1 - a);
    }
    RIS_CHANNELS
}

/* PxrThreshold: 1 where a number is above threshold, 0 below, over a width of transitionWidth, of RIS. */
#include "rispattern.h"
surface PxrThreshold(varying color inputRGB = 0; varying float threshold = .5, transitionWidth = .1; float invert = 0; RIS_RGB; output varying float resultF = 0) {
    float x = risLuminance(inputRGB), w = max(transitionWidth, 1e-4);
    resultF = smoothstep(threshold - w / 2, threshold + w / 2, x);
    if (invert != 0) resultF = 1 - resultF;
    resultRGB = resultF;
    RIS_CHANNELS
}

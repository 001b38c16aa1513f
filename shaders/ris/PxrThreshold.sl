/* PxrThreshold: 1 where a number is above threshold, 0 below, over a width of transitionWidth, of RIS: the channel 0 red, 1 green, 2 blue or 3 luminance; transitionProfile 0 goes straight, 1 smoothly. */
#include "rispattern.h"
surface PxrThreshold(varying color inputRGB = 0; varying float threshold = .5, transitionWidth = .05; float channel = 3, transitionProfile = 1, invert = 0; RIS_RGB; output varying float resultF = 0) {
    float x = (channel < 3) ? comp(inputRGB, channel) : risLuminance(inputRGB), w = max(transitionWidth, 1e-4);
    resultF = (transitionProfile == 0) ? clamp((x - threshold) / w + .5, 0, 1) : smoothstep(threshold - w / 2, threshold + w / 2, x);
    if (invert != 0) resultF = 1 - resultF;
    resultRGB = resultF;
    RIS_CHANNELS
}

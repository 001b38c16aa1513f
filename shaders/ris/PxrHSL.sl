/* PxrHSL: hue turned by hue (a part of a circle), saturation and luminance scaled, of RIS. */
#include "rispattern.h"
surface PxrHSL(varying color inputRGB = 0; varying float inputAlpha = 1, hue = 0, saturation = 1, luminance_ = 1; RIS_RGB; output varying float resultA = 1) {
    resultRGB = risAdjust("hsl", inputRGB, 360 * hue, saturation, luminance_);
    resultA = inputAlpha;
    RIS_CHANNELS
}

/* PxrColorCorrect: a colour corrected, of RIS, in this order: inputMin and inputMax to 0 and 1, gamma, contrast, rgbGain, hsv (turn of hue in parts of a circle,
   scales of saturation and value), exposure, outputMin and outputMax, clamp; by mask (or inputMask), which invertMask turns round, times mixMask. Not done: midtones of later versions. */
#include "rispattern.h"
surface PxrColorCorrect(varying color inputRGB = 0; varying float inputAlpha = 1, mask = 1, inputMask = 1, mixMask = 1; float invertMask = 0; color inputMin = 0, inputMax = 1, gamma_ = 1, contrast = 0, contrastPivot = .5, rgbGain = 1, hsv = color(0, 1, 1); float saturation = 1, exposure = 0, clampOutput = 0; color outputMin = 0, outputMax = 1, clampMin = 0, clampMax = 1;
                        RIS_RGB; output varying float resultA = 1) {
    color c = color(risUnit(comp(inputRGB, 0), comp(inputMin, 0), comp(inputMax, 0)), risUnit(comp(inputRGB, 1), comp(inputMin, 1), comp(inputMax, 1)), risUnit(comp(inputRGB, 2), comp(inputMin, 2), comp(inputMax, 2)));
    c = risPower(c, color(1 / comp(gamma_, 0), 1 / comp(gamma_, 1), 1 / comp(gamma_, 2)));
    c = (c - contrastPivot) * (1 + contrast) + contrastPivot;
    c *= rgbGain;
    if (hsv != color(0, 1, 1)) c = risAdjust("hsv", c, 360 * comp(hsv, 0), comp(hsv, 1), comp(hsv, 2));
    c = risSaturate(c, saturation) * pow(2, exposure);
    c = outputMin + c * (outputMax - outputMin);
    if (clampOutput != 0) c = clamp(c, clampMin, clampMax);
    resultRGB = mix(inputRGB, c, color(mixMask * ((invertMask != 0) ? 1 - mask * inputMask : mask * inputMask)));
    resultA = inputAlpha;
    RIS_CHANNELS
}

/* PxrRemap: channels from inputMin..inputMax to 0..1, by gamma, bias and gain (K. Perlin, 1989), to outputMin..outputMax, of RIS; clampInput and clampOutput keep them there. */
#include "rispattern.h"
surface PxrRemap(varying color inputRGB = 0; varying float inputMin = 0, inputMax = 1, gamma_ = 1; varying color bias = .5, gain = .5; varying float outputMin = 0, outputMax = 1; float clampInput = 1, clampOutput = 1; RIS_RGB; output varying float resultF = 0, resultA = 1) {
    float one(float c, b, k;) {
        float x = risUnit(c, inputMin, inputMax);
        if (clampInput != 0) x = clamp(x, 0, 1);
        if (gamma_ != 1) x = pow(max(x, 0), 1 / gamma_);
        if (b != .5) x = risBias(clamp(x, 0, 1), b);
        if (k != .5) x = risGain(clamp(x, 0, 1), k);
        x = outputMin + x * (outputMax - outputMin);
        return (clampOutput != 0) ? clamp(x, min(outputMin, outputMax), max(outputMin, outputMax)) : x;
    }
    resultRGB = color(one(comp(inputRGB, 0), comp(bias, 0), comp(gain, 0)), one(comp(inputRGB, 1), comp(bias, 1), comp(gain, 1)), one(comp(inputRGB, 2), comp(bias, 2), comp(gain, 2)));
    RIS_CHANNELS
    resultF = resultR;
}

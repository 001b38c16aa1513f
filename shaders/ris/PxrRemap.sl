/* PxrRemap: channels from inputMin..inputMax to 0..1, by gamma, bias and gain (K. Perlin, 1989), to outputMin..outputMax, of RIS; clamp keeps them there. */
#include "rispattern.h"
surface PxrRemap(varying color inputRGB = 0; varying float inputMin = 0, inputMax = 1, gamma_ = 1, bias = .5, gain = .5, outputMin = 0, outputMax = 1; float clamp_ = 0; RIS_RGB; output varying float resultF = 0) {
    float one(float c, low, high, g, b, k, from, to, cut;) {
        float x = risUnit(c, low, high);
        if (cut != 0) x = clamp(x, 0, 1);
        if (g != 1) x = pow(max(x, 0), 1 / g);
        if (b != .5) x = risBias(clamp(x, 0, 1), b);
        if (k != .5) x = risGain(clamp(x, 0, 1), k);
        return from + x * (to - from);
    }
    resultRGB = color(one(comp(inputRGB, 0), inputMin, inputMax, gamma_, bias, gain, outputMin, outputMax, clamp_), one(comp(inputRGB, 1), inputMin, inputMax, gamma_, bias, gain, outputMin, outputMax, clamp_), one(comp(inputRGB, 2), inputMin, inputMax, gamma_, bias, gain, outputMin, outputMax, clamp_));
    RIS_CHANNELS
    resultF = resultR;
}

/* PxrExposure: a colour times gain times 2^stops (or exposure), of RIS, then by gamma. */
#include "rispattern.h"
surface PxrExposure(varying color inputRGB = 0; varying float stops = 0, exposure = 0, gain = 1, gamma_ = 1; RIS_RGB) {
    resultRGB = inputRGB * gain * pow(2, stops + exposure);
    if (gamma_ != 1) resultRGB = risPower(resultRGB, color(1 / gamma_));
    RIS_CHANNELS
}

/* PxrGamma: a colour to the power 1 / gamma, of RIS. */
#include "rispattern.h"
surface PxrGamma(varying color inputRGB = 0; varying float gamma_ = 1; RIS_RGB) {
    resultRGB = risPower(inputRGB, color(1 / gamma_));
    RIS_CHANNELS
}

/* PxrClamp: channels kept between those of min and max, of RIS; modulus 1: brought there by whole multiples of the distance. */
#include "rispattern.h"
surface PxrClamp(varying color inputRGB = 0; varying color min_ = 0, max_ = 1; float modulus = 0; RIS_RGB) {
    float one(float x, low, high;) {
        float whole = max(high - low, 1e-6);
        return (modulus != 0) ? low + mod(x - low, whole) : clamp(x, low, high);
    }
    resultRGB = color(one(comp(inputRGB, 0), comp(min_, 0), comp(max_, 0)), one(comp(inputRGB, 1), comp(min_, 1), comp(max_, 1)), one(comp(inputRGB, 2), comp(min_, 2), comp(max_, 2)));
    RIS_CHANNELS
}

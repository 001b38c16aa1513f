/* PxrClamp: channels kept between min and max, of RIS. */
#include "rispattern.h"
surface PxrClamp(varying color inputRGB = 0; varying float min_ = 0, max_ = 1; RIS_RGB) {
    resultRGB = clamp(inputRGB, color(min_), color(max_));
    RIS_CHANNELS
}

// The transfer function of sRGB (IEC 61966-2-1).
#pragma once
#include "base/exact.h"
#include <cmath>

namespace alpenglow {

/// From light, 1 = white, to the value that is stored. Monotone and defined for all numbers: a straight line below 0.0031308,
/// also below 0.
inline float srgbEncode(float light) {
    return light <= 0.0031308f ? 12.92f * light : float(1.055 * exact::pow(double(light), 1 / 2.4) - 0.055);
}
/// And back.
inline float srgbDecode(float stored) {
    return stored <= 0.04045f ? stored / 12.92f : float(exact::pow((double(stored) + 0.055) / 1.055, 2.4));
}

} // namespace alpenglow

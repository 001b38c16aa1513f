// Half floats by Imath: rounded to nearest, ties to even.
#pragma once
#define IMATH_HALF_NO_LOOKUP_TABLE // avoids linking a table
#include <Imath/half.h>
#include <cstdint>

namespace alpenglow {

/// The bits of the nearest half; infinity from 65,520 on.
inline uint16_t toHalf(float f) { return imath_float_to_half(f); }
/// The value of a half's bits; exact.
inline float ofHalf(uint16_t h) { return imath_half_to_float(h); }

} // namespace alpenglow

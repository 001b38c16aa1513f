// Limits of this room (base/limits.h says what they are for).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr size_t kMicropolygonBytes = size_t(1) << 20; ///< of shaded micropolygons that a thread keeps, about

} // namespace alpenglow::limits

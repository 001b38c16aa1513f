// Limits of this room (base/limits.h says what they are for).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr size_t kMicropolygonBytes = size_t(1) << 20; ///< of shaded micropolygons that a thread keeps, about
inline constexpr size_t kPartialsBytes = size_t(16) << 20;    ///< of tables of large surfaces that a thread keeps

} // namespace alpenglow::limits

// Limits of this folder (purpose: base/limits.h).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr size_t kMicropolygonBytes = size_t(1) << 20; ///< shaded micropolygons in the cache of a thread, about
inline constexpr size_t kPartialsBytes = size_t(16) << 20;    ///< tables of large surfaces in the cache of a thread

} // namespace alpenglow::limits

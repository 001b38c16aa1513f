// Limits of this room (base/limits.h says what they are for).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr int kFramesAtOnce = 256; ///< processes that draw frames at a time (--frames-at-once)
inline constexpr int kFramesAhead = 4;    ///< times their number: frames behind the first that is not told of, drawn or not
inline constexpr size_t kHeapAtOnce = size_t(256) << 20; ///< that such a process takes at once, before it draws

} // namespace alpenglow::limits

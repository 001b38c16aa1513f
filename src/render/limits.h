// Limits of this folder (purpose: base/limits.h).
#pragma once
#include <cstddef>

namespace alpenglow::limits {

inline constexpr int kFramesAtOnce = 256; ///< processes that render frames at once (--frames-at-once)
inline constexpr int kFramesAhead = 4;    ///< factor: frames after the first that is not yet printed, rendered or not
inline constexpr size_t kHeapAtOnce = size_t(256) << 20; ///< memory that such a process allocates before it renders

} // namespace alpenglow::limits

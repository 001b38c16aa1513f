// Interface of base/numberlanes.h to its code in lanes. No standard header beyond <cstdint>: code for newer processors must not
// leave a copy of a library's inline function for others.
#pragma once
#include <cstdint>

namespace alpenglow {

/// Rows of requests for numbers, and the results. `stream`: call site, and whether a pair or a single number (x).
struct alignas(64) NumberBlock {
    static constexpr int kSize = 16; ///< requests of a block
    /// Keys of the requests, as in Sampler::get2().
    uint32_t low[kSize], high[kSize], index[kSize], vertex[kSize], stream[kSize], occurrence[kSize];
    float x[kSize], y[kSize]; ///< results in [0, 1)
};

/// Fills x and y of the blocks.
using DrawNumbers = void (*)(NumberBlock*, uint64_t blocks);
/// The same at 4, 8 or 16 lanes; null where this processor cannot run that.
DrawNumbers drawNumbers(int lanes);

} // namespace alpenglow

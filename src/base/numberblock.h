// What base/numberlanes.h asks its code in lanes. No standard header beyond <cstdint>: what compiles for newer processors must
// not leave a copy of a library's inline function behind for others.
#pragma once
#include <cstdint>

namespace alpenglow::render {

/// Rows of requests for numbers, and of what they get. `stream`: the site, and whether a pair or one number; one number is x.
struct alignas(64) NumberBlock {
    static constexpr int kSize = 16;
    uint32_t low[kSize], high[kSize], index[kSize], vertex[kSize], stream[kSize], occurrence[kSize];
    float x[kSize], y[kSize];
};

/// Fills x and y of so many blocks.
using DrawNumbers = void (*)(NumberBlock*, uint64_t blocks);
/// The same at 4, 8 or 16 lanes; null where this processor cannot run that.
DrawNumbers drawNumbers(int lanes);

} // namespace alpenglow::render

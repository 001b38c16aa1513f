// The integer hash of samples and dither.
#pragma once
#include <cstdint>

namespace alpenglow {

/// A bijection of 64-bit integers (no collisions) in which every output bit depends on every input bit. The finaliser "Mix13" of
/// D. Stafford, "Better Bit Mixing" (2011).
constexpr uint64_t mix64(uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9ull;
    v = (v ^ (v >> 27)) * 0x94d049bb133111ebull;
    return v ^ (v >> 31);
}

/// The 24 high bits of h as a float in [0, 1): never 1.
constexpr float unitFloat(uint32_t h) { return float(h >> 8) * 0x1p-24f; }

} // namespace alpenglow

// The large tests of `./check --all`: many cases, expensive sizes. Without them a test keeps what its comment says of it.
#pragma once
#include <cstddef>
#include <cstdlib>

namespace alpenglow {

inline bool nightly() { return std::getenv("ALPENGLOW_NIGHTLY") != nullptr; }
/// Of the cases of a sweep, by number: nightly all, else every `stride`-th from the first on.
inline bool chosen(size_t number, size_t stride) { return nightly() || number % stride == 0; }

} // namespace alpenglow

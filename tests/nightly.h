// The large tests of `./check --all`: many cases, expensive sizes. Without them a test keeps what its comment says of it.
#pragma once
#include <cstdlib>

namespace alpenglow {

inline bool nightly() { return std::getenv("ALPENGLOW_NIGHTLY") != nullptr; }

} // namespace alpenglow

// Limits of photon maps, in addition to base/limits.h.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::limits {

inline constexpr size_t kPhotons = 20'000'000;           ///< in one photon map
inline constexpr uint64_t kPhotonsEmitted = 200'000'000; ///< by one Hider "photon"
inline constexpr uint32_t kPhotonsOfPass = 4'000'000;    ///< emitted for one sample of every pixel (Hider "path" "caustics")
inline constexpr size_t kPhotonsAtRest = 1'500'000;      ///< stored for one such sample; 8 of these are held at once

} // namespace alpenglow::limits

// Limits of photon maps, beside those of base/limits.h.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::limits {

inline constexpr size_t kPhotons = 20'000'000;           ///< of one photon map
inline constexpr uint64_t kPhotonsEmitted = 200'000'000; ///< by one Hider "photon"
inline constexpr uint32_t kPhotonsOfPass = 4'000'000;    ///< emitted for one sample of every pixel (Hider "path" "caustics")
inline constexpr size_t kPhotonsAtRest = 1'500'000;      ///< that are kept of one such sample; 8 of them are held at once

} // namespace alpenglow::limits

// How a gather is cut up, for those who build its loop and those who follow its rays.
#pragma once

namespace alpenglow::rsl {

inline constexpr int kGatherRays = 64; ///< of a gather, at a point, that are followed at once: what they bring waits in memory

} // namespace alpenglow::rsl

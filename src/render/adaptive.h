// Adaptive sampling under --noise: how many samples each pixel gets of those that come after the first (docs/noise.md).
#pragma once
#include "render/film.h"

namespace alpenglow::render {

/// Samples of every pixel by which rates are decided.
inline constexpr uint32_t kPilotSamples = 16;
/// Pixels on each side whose noise decides the rate of the one between them.
inline constexpr int kRateRadius = 3;
/// The least and the greatest rate, in units of the mean of those pixels whose neighbours show noise. Rates are powers of two:
/// where one pixel's samples are whole nets (base/sampler.h), those of all are; by other rates evenly noisy pictures became
/// noisier than without.
inline constexpr double kLeastRate = 1.0 / 8, kGreatestRate = double(Spread::kMost) / Spread::kOne;

/// The rates (Film::spread()) by which further samples of a film are shared out, which holds the same samples of every pixel. The
/// mean relative error over the pixels, sum r_i / sqrt(n_i) with r_i of one sample, is least for a given sum n_i where n_i is in
/// proportion to r_i^(2/3). r_i^2 is taken from the two scrambles (relativeReplicaError()) of the pixels about pixel i **without
/// pixel i itself**, and the unit from those further away: no number of samples depends on what is averaged over them, so every
/// mean stays unbiased. All 256 where there is no noise, or nothing further away.
std::vector<uint16_t> ratesOf(const Film&);

} // namespace alpenglow::render

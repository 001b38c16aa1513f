// Adaptive sampling under --noise: how many further samples each pixel gets (docs/noise.md).
#pragma once
#include "render/film.h"

namespace alpenglow::render {

/// Samples of every pixel that determine the rates.
inline constexpr uint32_t kPilotSamples = 16;
/// Radius in pixels of the neighbourhood whose noise determines the rate of its centre.
inline constexpr int kRateRadius = 3;
/// Smallest and largest rate, relative to the mean over pixels with noisy neighbours. Rates are powers of two: then the samples
/// of all pixels are complete nets (base/sampler.h) if those of one pixel are. With other rates, uniformly noisy pictures became
/// noisier.
inline constexpr double kLeastRate = 1.0 / 8, kGreatestRate = double(Spread::kMost) / Spread::kOne;

/// The rates (Film::spread()) for further samples of a film whose pixels all have the same number of samples. The mean relative
/// error over the pixels, sum r_i / sqrt(n_i) with r_i the error of one sample, is minimal for a given sum n_i if n_i is
/// proportional to r_i^(2/3). r_i^2 is estimated from the two replicas (relativeReplicaError()) of the pixels around pixel i
/// **without pixel i itself**, and the normalisation from pixels further away: no number of samples depends on the values that it
/// averages, so every mean stays unbiased. All rates are 256 without noise, or without pixels further away.
std::vector<uint16_t> ratesOf(const Film&);

} // namespace alpenglow::render

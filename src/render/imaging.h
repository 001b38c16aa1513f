// The imaging pipeline after filtering (RISpec 3.2, 4.1.2): exposure, then quantise and dither. The imager
// shader runs between the two and is the caller's. Also the sample clamp (docs/design/slproject.md).
#pragma once
#include "base/vec.h"
#include <cstdint>

namespace alpenglow::render {

/// RiExposure: (gain * v)^(1/gamma). Negative values (filters with negative lobes) keep their sign. gamma <= 0 counts as 1.
float expose(float v, float gain, float gamma);
Color expose(Color, float gain, float gamma);

/// RiQuantize and the Display parameter "quantize" [zero one min max]. one == zero == 0: floating point output.
struct QuantizeRule {
    double zero = 0, one = 0, min = 0, max = 0, dither = 0; ///< the numbers of the request
    /// Not quantised.
    bool floating() const { return one == 0 && zero == 0; }
};

/// round(zero + v (one - zero) + dither * r), clamped to [min, max]; ties to even; NaN gives min. r in [-1, 1) depends on (seed,
/// x, y, channel) only. Floating rules return v unchanged, without rounding or clamping.
double quantize(double v, const QuantizeRule&, uint64_t seed, int x, int y, int channel);
/// The random number r of quantize().
double ditherValue(uint64_t seed, int x, int y, int channel);

/// Limits the brightest channel of one sample before accumulation: if m = max(r, g, b) > limit > 0, the colour is scaled by limit
/// / m, which keeps the hue. limit <= 0: off. This is the only deliberate bias; it is never applied to means.
Color clampSample(Color, float limit);

} // namespace alpenglow::render

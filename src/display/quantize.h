// Quantisation of floats to integer codes (RISpec 3.2, 4.1.2). The last step, after exposure and imager; gamma is part of
// exposure, so quantisation does not change the colour space.
#pragma once
#include "base/diagnostics.h"
#include "scene/display.h"
#include <cstdint>

namespace alpenglow::display {

/// v = round(zero + value * (one - zero) + dither * noise), clamped to [min, max]; noise is in (-1, 1). one = 0: no quantisation.
/// With zero = 0 this is RiQuantize; the four-value form of a Display's "quantize" parameter has no dither.
struct Quantization {
    float zero = 0, one = 0, min = 0, max = 0, dither = 0;
    /// Not quantised: samples stay as they are.
    bool floating() const { return one == 0; }
    friend bool operator==(const Quantization&, const Quantization&) = default;
};

/// Returns the code. Half rounds up (floor(v + 1/2)), so that dither 1/2 preserves exact 8-bit codes. NaN becomes min. Returns
/// the value itself if floating().
float quantise(const Quantization&, float value, float noise);

/// Noise in (-1, 1), the same for a pixel of the full picture (raster coordinates, not those of a crop) and channel in every
/// render.
float ditherNoise(int x, int y, int channel);

/// Quantisation of one display: RiQuantize's values, overridden by the display's "quantize" [zero one min max] and "dither"
/// [amplitude] parameters. Invalid parameters are reported and ignored. *explicitly: whether the user set any.
Quantization quantizationOf(const scene::Quantize& ri, const scene::ParamList& params, Diagnostics&, bool* explicitly = nullptr);

} // namespace alpenglow::display

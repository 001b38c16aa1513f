// Deep shadow maps: transmittance along the rays of every pixel (Lokovic and Veach 2000).
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Largest error of a pixel's staircase relative to the mean of its samples: Option "limits" "deepshadowerror", 0 to 1.
float deepShadowError(const scene::Options&, Diagnostics&);

/// Pixels of the picture's window, in rows from the top: the unweighted mean of nx x ny samples in a pixel. Returns null if
/// stopped, or if the steps do not fit into memory (reported).
std::shared_ptr<const display::DeepSamples> seeDepths(Job&, int nx, int ny, Jitter, uint64_t seed, float error);

} // namespace alpenglow::render

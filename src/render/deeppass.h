// Deep shadow maps: what is left of light along the rays of every pixel (Lokovic, Veach 2000).
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// How far the staircase of a pixel may lie from the mean of its samples: Option "limits" "deepshadowerror", 0 to 1.
float deepShadowError(const scene::Options&, Diagnostics&);

/// Pixels of the picture's window, rows from the top: the plain mean of nx x ny samples in a pixel. Null: stopped, or more
/// steps than fit into memory (reported).
std::shared_ptr<const display::DeepSamples> seeDepths(Job&, int nx, int ny, Jitter, uint64_t seed, float error);

} // namespace alpenglow::render

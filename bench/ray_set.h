// The rays that a path tracer sends through a scene, by kind: what bench/ray_bench.cpp times.
#pragma once
#include "accel/accel.h"
#include "scene/scene.h"
#include <map>
#include <string>
#include <vector>

namespace alpenglow::bench {

struct RaysOfKind {
    bool any = false; ///< shadow rays: whether anything is met is asked
    std::vector<accel::Ray> rays;
};

/// By name: "camera", "bounce 1", "bounce 2", "bounce 3+", "onward" (behind what lets rays through), and shadow rays to each kind
/// of light, "lamp", "sky", "sun", of the first point of a path and, "lamp 2+", of all later ones.
///
/// Surfaces are matte, those named "leaf" let a fifth of all rays through where they are and half of the rest through the leaf,
/// "null" lets all through, and within what has an interior a ray flies two units on average. One path a pixel, in tiles of eight
/// pixels, or as many as give `most` rays of the camera. The same rays for the same hits.
std::map<std::string, RaysOfKind> raysOf(const scene::Frame&, const accel::Accel&, size_t most, Diagnostics&);

} // namespace alpenglow::bench

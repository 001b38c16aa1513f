// The shapes of lookup filters (Filter) beyond box, triangle and gaussian: RISpec's pixel filters over the footprint of a lookup.
#pragma once
#include "texture/lookuplanes.h"

namespace alpenglow::texture {

/// A kernel at (x, y), in footprints: a side of the footprint has length 1. Not normalised.
struct Kernel2 {
    float radius;                       ///< half its full width: .5 (disk), 2, or the third zero of J1(pi r) (bessel)
    bool radial;                        ///< of the distance only; else a product of one factor an axis
    float texels;                       ///< minimum number of texels along a side of the footprint, if the map has as many
    const float* row;                   ///< kSteps + 1 values from 0 to radius
    static constexpr int kSteps = 1024; ///< of the table
    /// At distance r, 0 or more.
    float at(float r) const;
};
/// Of a filter that hasShape().
const Kernel2& filterKernel(Filter);

} // namespace alpenglow::texture

// Points of primitives that are shaded regardless of visibility: complete grids for baking, and micropolygons seen by camera
// samples.
#pragma once
#include <cstdint>

namespace alpenglow::shading {

/// A point on a primitive that is shaded as a part of its grid.
struct GridPoint {
    uint32_t shape = 0, prim = 0; ///< as in a hit
    double b1 = 0, b2 = 0;        ///< as in a hit
    float distance = 0;           ///< from the origin of its ray
    float radius = 0;             ///< of a disk that covers its part of the surface; camera space
    float area = 0;               ///< of its part of the surface; sums to the area of the shape over a grid
    bool corner = true;           ///< a corner of micropolygons; else a centre
    /// Change of u and v over its micropolygon, both > 0: du and dv of shaders. 0: those of its ray.
    float du = 0, dv = 0;
    /// Not 0: a micropolygon for camera samples rather than baking, with this random number key.
    uint64_t micropolygon = 0;
    uint64_t run = 0; ///< rsl::PrintKey::run
};

} // namespace alpenglow::shading

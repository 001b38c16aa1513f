// Points of primitives that are shaded whatever lies before them: of whole grids, for what shaders bake there, seen or not; and
// of the micropolygons that camera samples see.
#pragma once
#include <cstdint>

namespace alpenglow::shading {

struct GridPoint {
    uint32_t shape = 0, prim = 0; ///< as a hit has them
    double b1 = 0, b2 = 0;
    float distance = 0; ///< from the origin of its ray
    float radius = 0;   ///< of a disk that covers its part of the surface; camera space
    float area = 0;     ///< of its part of the surface: of all points of a grid they add up to the shape
    bool corner = true; ///< of micropolygons; else the middle of one
    /// What u and v change by over its micropolygon, both more than 0: du and dv of shaders. 0: they have those of its ray.
    float du = 0, dv = 0;
    /// Not 0: not for what it bakes, but a micropolygon that camera samples take, by this key of its random numbers.
    uint64_t micropolygon = 0;
    uint64_t run = 0; ///< rsl::PrintKey::run
};

} // namespace alpenglow::shading

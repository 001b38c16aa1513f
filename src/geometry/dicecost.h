// The cost of dicing, and the note about expensive primitives.
#pragma once
#include "geometry/dice.h"
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// What dicing one shape took.
struct DiceCost {
    double seconds = 0; ///< of a processor
    size_t bytes = 0;   ///< of the mesh
};

/// Seconds of a processor that this thread has had.
double threadSeconds();
/// Of a shape that took so many seconds.
DiceCost costOf(const Shape&, double seconds);
/// Reports the most expensive primitive, if it exceeds the threshold of DiceOptions.
void noteCosts(const std::vector<ShapeRef>&, const std::vector<DiceCost>&, const DiceOptions&, Diagnostics&);

} // namespace alpenglow::geometry

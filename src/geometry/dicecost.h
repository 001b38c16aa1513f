// What dicing costs, and the note about what costs much.
#pragma once
#include "geometry/dice.h"
#include "geometry/shape.h"

namespace alpenglow::geometry {

struct DiceCost {
    double seconds = 0; ///< of a processor
    size_t bytes = 0;   ///< of the mesh that is kept
};

/// Seconds of a processor that this thread has had.
double threadSeconds();
DiceCost costOf(const Shape&, double seconds);
/// A note that names the primitive that cost most, where that is more than DiceOptions says.
void noteCosts(const std::vector<ShapeRef>&, const std::vector<DiceCost>&, const DiceOptions&, Diagnostics&);

} // namespace alpenglow::geometry

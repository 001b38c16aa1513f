// From the description of a frame to shapes in camera space.
#pragma once
#include "base/limits.h"
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// Makes a shape of one primitive; null when it was reported as faulty or not yet drawn. attributes may be null (defaults). facing: what
/// curves and points turn to.
ShapeRef buildShape(const scene::PrimitiveRef&, const scene::AttributesRef& attributes, const Matrix& toCamera, int instance,
                    Diagnostics&, Facing facing = Facing::Ray);

/// All shapes of a frame: its primitives in order, then its instances expanded in order (their primitives' transforms
/// composed; the instance's attributes). Moving transforms and primitives stand at their first key, said once. What is beyond
/// `most` is reported and left out.
std::vector<ShapeRef> buildShapes(const scene::Frame&, Diagnostics&, size_t most = limits::kShapes);

} // namespace alpenglow::geometry

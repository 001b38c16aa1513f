// From the description of a frame to shapes in camera space.
#pragma once
#include "base/limits.h"
#include "geometry/shape.h"
#include "scene/fwd.h"

namespace alpenglow::geometry {

/// Makes a shape of one primitive; null when it was reported as faulty or not yet drawn. attributes may be null (defaults).
/// facing: what curves and points turn to. like: ShapeSource::like.
ShapeRef buildShape(const scene::PrimitiveRef&, const scene::AttributesRef& attributes, const Matrix& toCamera, int instance,
                    Diagnostics&, Facing facing = Facing::Ray, const Shape* like = nullptr);

/// What buildShapes() is told beside the frame.
struct BuildOptions {
    size_t most = limits::kShapes; ///< what is beyond is reported and left out
    /// Primitives of an object whose instances have more numbers than this in their points, taken together, are shared by them
    /// (geometry/placed.h); the others are made anew for each instance, which rays meet faster.
    size_t shareFrom = size_t(1) << 20;
};

/// All shapes of a frame: its primitives in order, then its instances expanded in order (their primitives' transforms
/// composed; the instance's attributes). Camera space is that of the camera when the shutter opens. What moves while it is open,
/// or is shared by many instances, is geometry::Placed.
std::vector<ShapeRef> buildShapes(const scene::Frame&, Diagnostics&, const BuildOptions& = {});

} // namespace alpenglow::geometry

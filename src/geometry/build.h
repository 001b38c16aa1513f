// From the description of a frame to shapes in camera space.
#pragma once
#include "base/limits.h"
#include "geometry/shape.h"
#include "scene/fwd.h"

namespace alpenglow::geometry {

/// Makes the shape of one primitive; returns null if it is invalid or not supported, which is reported. attributes may be null
/// (defaults). facing: direction of curves and points. like: ShapeSource::like.
ShapeRef buildShape(const scene::PrimitiveRef&, const scene::AttributesRef& attributes, const Matrix& toCamera, int instance,
                    Diagnostics&, Facing facing = Facing::Ray, const Shape* like = nullptr);

/// Options of buildShapes().
struct BuildOptions {
    size_t most = limits::kShapes; ///< maximum number of shapes; others are dropped and reported
    /// Primitives whose instances together have more point coordinates than this share one geometry (geometry/placed.h); smaller
    /// ones are copied for each instance, which is faster for rays.
    size_t shareFrom = size_t(1) << 20;
};

/// All shapes of a frame: its primitives in order, then its expanded instances in order (with composed transforms and the
/// instance's attributes). Camera space is that at shutter open. Moving or shared shapes are geometry::Placed.
std::vector<ShapeRef> buildShapes(const scene::Frame&, Diagnostics&, const BuildOptions& = {});

} // namespace alpenglow::geometry

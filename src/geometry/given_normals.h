// The front of a shape with given normals: the side that they are on. Files may reverse the orientation of primitives
// (ReverseOrientation) whose normals are already reversed, or wind faces against their normals.
#pragma once
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// Where the orientation has the front of a shape, by its normals.
enum class NormalsSay {
    Nothing, ///< none given, or on both sides of the faces: the orientation applies
    Front,   ///< they are on the front
    Back     ///< they are on the back
};

/// Determines the side of the given normals; independent of the position of the shape. Call before dicing. Reports
/// inconsistencies.
NormalsSay normalsSay(const Shape&, Diagnostics&);

} // namespace alpenglow::geometry

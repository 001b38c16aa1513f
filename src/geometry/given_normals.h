// Which side of a shape is its front, where its normals are given: the one that they are on. Files turn their primitives inside
// out (ReverseOrientation) and give normals that are turned already, or wind faces against their normals.
#pragma once
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// Where the orientation has the front of a shape, by its normals.
enum class NormalsSay {
    Nothing, ///< none are given, or they lie on both sides of the faces: the orientation holds
    Front,   ///< they lie where the front is
    Back     ///< they lie on the other side
};

/// What the given normals say; the same wherever the shape is placed. Before the shape is diced. A note says what is amiss.
NormalsSay normalsSay(const Shape&, Diagnostics&);

} // namespace alpenglow::geometry

// Position of a point on its face, for textures with one picture for each face (ptexture()).
#pragma once
#include "geometry/shape.h"
#include <optional>

namespace alpenglow::geometry {

/// The face, and where in it the point is.
struct FacePlace {
    int face = 0;       ///< of the request
    float u = 0, v = 0; ///< 0 to 1 from its first corner to the second, and to the last
    Vec3 Pu, Pv;        ///< derivatives of the point; camera space, at shutter open
};
/// For triangles and quadrilaterals of polygon meshes, which are linear over each of their triangles, and for faces of
/// subdivision surfaces and patches with u and v. Returns nothing if the face has more corners, or holes.
std::optional<FacePlace> facePlace(const Shape&, const SurfacePoint&);

} // namespace alpenglow::geometry

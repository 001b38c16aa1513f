// Where a point lies on its face, for textures that have one picture a face (ptexture()).
#pragma once
#include "geometry/shape.h"
#include <optional>

namespace alpenglow::geometry {

struct FacePlace {
    int face = 0;       ///< of the request
    float u = 0, v = 0; ///< 0 to 1 from its first corner to the second, and to the last
    Vec3 Pu, Pv;        ///< how the point moves with them; camera space, as the shape stands when the shutter opens
};
/// Of triangles and quadrilaterals of polygon meshes, which are linear over each triangle that they are cut into, and of faces of
/// subdivision surfaces and patches, which have u and v. Nothing: the face has more corners, or holes.
std::optional<FacePlace> facePlace(const Shape&, const SurfacePoint&);

} // namespace alpenglow::geometry

#include "geometry/faceplace.h"
#include "geometry/placed.h"
#include "geometry/polygon_mesh.h"
#include <algorithm>

namespace alpenglow::geometry {

bool PolygonMesh::placeOnFace(uint32_t tri, double b1, double b2, FacePlace& to) const {
    const uint32_t face = faceOf(tri);
    uint32_t first = cornerOf(tri, 0), last = first;
    uint32_t begin = tri, end = tri + 1;
    if (!face_.empty()) {
        while (begin > 0 && face_[begin - 1] == face) --begin;
        while (end < triangles_ && face_[end] == face) ++end;
    }
    for (uint32_t t = begin; t < end; ++t)
        for (int k = 0; k < 3; ++k) {
            first = std::min(first, cornerOf(t, k));
            last = std::max(last, cornerOf(t, k));
        }
    const uint32_t corners = last - first + 1;
    if (corners < 3 || corners > 4 || end - begin != corners - 2) return false;
    // Corners are at (0, 0), (1, 0), (1, 1), (0, 1); for triangles at (0, 0), (1, 0), (0, 1).
    double u[3], v[3];
    for (int k = 0; k < 3; ++k) {
        const uint32_t c = cornerOf(tri, k) - first;
        u[k] = c == 1 || (c == 2 && corners == 4);
        v[k] = c >= 2;
    }
    to.face = int(face);
    to.u = float(u[0] + (u[1] - u[0]) * b1 + (u[2] - u[0]) * b2);
    to.v = float(v[0] + (v[1] - v[0]) * b1 + (v[2] - v[0]) * b2);
    const Vec3d a = cameraCorner(tri, 0), e1 = cameraCorner(tri, 1) - a, e2 = cameraCorner(tri, 2) - a;
    const double u1 = u[1] - u[0], u2 = u[2] - u[0], v1 = v[1] - v[0], v2 = v[2] - v[0], det = u1 * v2 - u2 * v1;
    if (det == 0) return false;
    to.Pu = Vec3((e1 * v2 - e2 * v1) / det);
    to.Pv = Vec3((e2 * u1 - e1 * u2) / det);
    return true;
}

std::optional<FacePlace> facePlace(const Shape& shape, const SurfacePoint& p) {
    const Shape* at = &shape;
    if (const Placed* placed = shape.placed()) at = placed->geometry().get();
    if (const auto* moving = dynamic_cast<const Deforming*>(at)) at = moving->keys()[0].get();
    FacePlace to{p.face, p.u, p.v, p.dPdu, p.dPdv};
    const auto* mesh = dynamic_cast<const PolygonMesh*>(at);
    if (!mesh) return to;
    if (!mesh->placeOnFace(p.prim, p.b1, p.b2, to)) return {};
    if (at != &shape) {
        to.Pu = Vec3(transformVector(shape.toCamera(), Vec3d(to.Pu)));
        to.Pv = Vec3(transformVector(shape.toCamera(), Vec3d(to.Pv)));
    }
    return to;
}

} // namespace alpenglow::geometry

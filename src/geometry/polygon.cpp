// Polygon: one loop. Meant to be convex; published files hold concave ones, which are cut all the same.
#include "geometry/factories.h"
#include "geometry/polygon_mesh.h"
#include <numeric>

namespace alpenglow::geometry {

ShapeRef makePolygon(ShapeSource s, Diagnostics& diag) {
    const scene::Param* P = lastParam(s.primitive->params, "P");
    PolygonInput in;
    in.loopsPerFace = {1};
    in.vertex.resize(P ? P->numbers.size() / 3 : 0);
    std::iota(in.vertex.begin(), in.vertex.end(), 0);
    in.cornersPerLoop = {int(in.vertex.size())};
    return makePolygonMesh(std::move(s), std::move(in), diag);
}

} // namespace alpenglow::geometry

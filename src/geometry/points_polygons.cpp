// PointsPolygons nverts verts.
#include "geometry/factories.h"
#include "geometry/polygon_mesh.h"

namespace alpenglow::geometry {

ShapeRef makePointsPolygons(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    size_t sum = 0;
    bool ok = !p.ints.empty();
    for (int n : p.ints) {
        if (n < 0) ok = false;
        else sum += size_t(n);
    }
    if (!ok || sum > p.ints2.size()) {
        diag.report(Severity::Error, Rie::Consistency, p.place,
                    "PointsPolygons: nverts asks for " + std::to_string(sum) + " indices, " + std::to_string(p.ints2.size()) +
                        " are given; it is not drawn");
        return nullptr;
    }
    PolygonInput in;
    in.loopsPerFace.assign(p.ints.size(), 1);
    in.cornersPerLoop = p.ints;
    in.vertex.assign(p.ints2.begin(), p.ints2.begin() + ptrdiff_t(sum));
    in.kept = p.ints2;
    return makePolygonMesh(std::move(s), std::move(in), diag);
}

} // namespace alpenglow::geometry

// PointsGeneralPolygons nloops nverts verts.
#include "geometry/factories.h"
#include "geometry/polygon_mesh.h"

namespace alpenglow::geometry {

ShapeRef makePointsGeneralPolygons(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    size_t loops = 0, corners = 0;
    bool ok = !p.ints.empty();
    for (int n : p.ints) {
        if (n < 0) ok = false;
        else loops += size_t(n);
    }
    ok = ok && loops <= p.ints2.size();
    for (size_t i = 0; ok && i < loops; ++i) {
        if (p.ints2[i] < 0) ok = false;
        else corners += size_t(p.ints2[i]);
    }
    if (!ok || corners > p.ints3.size()) {
        diag.report(Severity::Error, Rie::Consistency, p.place,
                    "PointsGeneralPolygons: nloops, nverts and verts do not fit each other; it is not drawn");
        return nullptr;
    }
    PolygonInput in;
    in.loopsPerFace = p.ints;
    in.cornersPerLoop.assign(p.ints2.begin(), p.ints2.begin() + ptrdiff_t(loops));
    in.vertex.assign(p.ints3.begin(), p.ints3.begin() + ptrdiff_t(corners));
    return makePolygonMesh(std::move(s), std::move(in), diag);
}

} // namespace alpenglow::geometry

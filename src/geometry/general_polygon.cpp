// GeneralPolygon: an outer loop and holes.
#include "geometry/factories.h"
#include "geometry/polygon_mesh.h"
#include <numeric>

namespace alpenglow::geometry {

ShapeRef makeGeneralPolygon(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    const scene::Param* P = lastParam(p.params, "P");
    size_t points = P ? P->numbers.size() / 3 : 0, sum = 0;
    bool ok = !p.ints.empty();
    for (int n : p.ints) {
        if (n < 0) ok = false;
        else sum += size_t(n);
    }
    if (!ok || sum > points) {
        diag.report(Severity::Error, Rie::MissingData, p.place,
                    "GeneralPolygon: the loops need " + std::to_string(sum) + " points, " + std::to_string(points) +
                        " are given; it is not drawn");
        return nullptr;
    }
    PolygonInput in;
    in.loopsPerFace = {int(p.ints.size())};
    in.cornersPerLoop = p.ints;
    in.vertex.resize(sum);
    std::iota(in.vertex.begin(), in.vertex.end(), 0);
    return makePolygonMesh(std::move(s), std::move(in), diag);
}

} // namespace alpenglow::geometry

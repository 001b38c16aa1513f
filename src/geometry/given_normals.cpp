#include "geometry/given_normals.h"
#include "base/printable.h"
#include "scene/solids.h"
#include <algorithm>

namespace alpenglow::geometry {

namespace {

/// Number of faces sampled, uniformly over the mesh.
constexpr uint32_t kFacesLookedAt = 256;

/// Places along a parametric surface, in each direction.
constexpr int kPlacesAlong = 8;

struct Count {
    uint32_t front = 0, back = 0;
    void add(const SurfacePoint& p) {
        const float side = dot(p.N, p.n);
        front += side > 0;
        back += side < 0;
    }
};

Count lookAt(const Shape& s) {
    Count c;
    SurfacePoint p;
    if (const uint32_t triangles = s.mesh().triangles()) {
        const uint32_t n = std::min(triangles, kFacesLookedAt);
        for (uint32_t i = 0; i < n; ++i) {
            s.evaluateHit(uint32_t(uint64_t(triangles) * i / n), 1. / 3, 1. / 3, p, kNeedN);
            c.add(p);
        }
        return c;
    }
    // The middles of cells: away from poles and collapsed edges.
    const auto middle = [](int i) { return (i + .5) / kPlacesAlong; };
    for (int j = 0; j < kPlacesAlong; ++j)
        for (int i = 0; i < kPlacesAlong; ++i) c.add(s.evaluate(0, middle(i), middle(j)));
    return c;
}

/// Whether normals define a side: not for curves and points, which have their own rules, nor for subtracted parts of solids,
/// which show their inside.
bool meansSide(const Shape& s) {
    static constexpr const char* kOthers[] = {"Curves", "Points", "Blobby", "SubdivisionMesh", "HierarchicalSubdivisionMesh"};
    return s.givesNormals() && !scene::solidTakenAway(s.attributes()) &&
           std::none_of(std::begin(kOthers), std::end(kOthers), [&](const char* k) { return s.kind() == k; });
}

} // namespace

NormalsSay normalsSay(const Shape& s, Diagnostics& diag) {
    if (!meansSide(s)) return NormalsSay::Nothing;
    const Count c = lookAt(s);
    const uint32_t all = c.front + c.back, few = std::min(c.front, c.back);
    // Two thirds: the few places where rounding decides the side, which copies of a shape differ in, must not decide.
    const NormalsSay says = 3 * few > all || all == 0 ? NormalsSay::Nothing
                            : c.back > c.front        ? NormalsSay::Back
                                                      : NormalsSay::Front;
    Diagnostic d;
    // Copies that leave out a face or two are let be; a model of which more than a third is dark is broken.
    d.severity = says == NormalsSay::Nothing && all > 0 ? Severity::Warning : Severity::Info;
    d.place = s.place();
    if (10 * few > all) {
        d.message = s.kind() + ": \"N\" lies on the front of some faces and on the back of others (" + std::to_string(few) +
                    " of " + counted(all, "place") + " looked at); these look dark";
        d.hint = "wind all faces the same way as seen from the side of their normals, or omit \"N\"";
    } else if (says == NormalsSay::Back) {
        d.message = s.kind() + ": \"N\" lies on the back of its faces; the side of \"N\" is used as the front";
        d.hint = "use ReverseOrientation or reverse the winding of the faces to avoid this note";
    }
    if (!d.message.empty()) diag.reportOnce("normals:" + d.place.file + ":" + std::to_string(d.place.line), d);
    return says;
}

} // namespace alpenglow::geometry

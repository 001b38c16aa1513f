#include "geometry/dicecost.h"
#include "scene/scene.h"
#include "scene/shadingrate.h"
#include <algorithm>
#include <ctime>
#include <fmt/format.h>

namespace alpenglow::geometry {

double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

DiceCost costOf(const Shape& s, double seconds) {
    const TriMesh& m = s.mesh();
    // A point has its position and parameters, a triangle its corners.
    return {seconds, m.P.size() * (sizeof(Vec3) + sizeof(Vec2)) + m.made.size() * sizeof(uint32_t)};
}

void noteCosts(const std::vector<ShapeRef>& shapes, const std::vector<DiceCost>& costs, const DiceOptions& opt,
               Diagnostics& diag) {
    const auto share = [&](const DiceCost& c) {
        return std::max(c.seconds / opt.noteSeconds, double(c.bytes) / double(opt.noteBytes));
    };
    const auto dearest =
        std::max_element(costs.begin(), costs.end(), [&](const DiceCost& a, const DiceCost& b) { return share(a) < share(b); });
    if (dearest == costs.end() || share(*dearest) <= 1) return;
    const auto others = std::count_if(costs.begin(), costs.end(), [&](const DiceCost& c) { return share(c) > 1; }) - 1;
    const Shape& s = *shapes[size_t(dearest - costs.begin())];
    Diagnostic note{Severity::Info, Rie::NoError, s.place(), {}, {}, {}};
    note.message = fmt::format("{}: dicing it took {:.1f} s and {} MB, for {} facets at ShadingRate {:g}{}", s.kind(),
                               dearest->seconds, dearest->bytes >> 20, s.mesh().triangles(), scene::shadedArea(s.attributes()),
                               others == 0   ? ""
                               : others == 1 ? "; another primitive was expensive as well"
                                             : fmt::format("; {} other primitives were expensive as well", others));
    note.hint = "a larger ShadingRate before it makes fewer facets";
    note.always = true;
    diag.report(std::move(note));
}

} // namespace alpenglow::geometry

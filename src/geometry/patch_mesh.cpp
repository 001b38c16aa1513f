// PatchMesh type nu uwrap nv vwrap. "nowrap" is an old spelling of "nonperiodic".
#include "geometry/control_net.h"
#include "geometry/factories.h"

namespace alpenglow::geometry {

ShapeRef makePatchMesh(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    auto fail = [&](Rie code, const std::string& why) -> ShapeRef {
        diag.report(Severity::Error, code, p.place, "PatchMesh: " + why + "; it is not drawn");
        return nullptr;
    };
    if (p.strings.size() < 3 || p.ints.size() < 2) return fail(Rie::MissingData, "type, counts and wraps are needed");
    bool cubic = p.strings[0] == "bicubic";
    if (!cubic && p.strings[0] != "bilinear")
        return fail(Rie::BadToken, "type \"" + p.strings[0] + "\" is neither \"bilinear\" nor \"bicubic\"");
    bool wrap[2];
    for (size_t k = 0; k < 2; ++k) {
        const std::string& w = p.strings[k + 1];
        wrap[k] = w == "periodic";
        if (!wrap[k] && w != "nonperiodic" && w != "nowrap")
            diag.report(Severity::Warning, Rie::BadToken, p.place,
                        "PatchMesh: wrap \"" + w + "\" is unknown; \"nonperiodic\" is used");
    }
    const scene::Attributes& a = *s.attributes;
    NetDirection dir[2];
    for (size_t k = 0; k < 2; ++k) {
        int n = p.ints[k];
        const scene::Basis& b = k == 0 ? a.ubasis : a.vbasis;
        int step = b.step < 1 ? 1 : b.step;
        const char* name = k == 0 ? "nu" : "nv";
        if (n > (1 << 24)) return fail(Rie::Limit, std::string(name) + " is too large");
        if (!cubic) {
            if (n < 2) return fail(Rie::Range, std::string(name) + " must be at least 2");
            dir[k] = NetDirection::linear(n, wrap[k]);
            continue;
        }
        if (n < (wrap[k] ? step : 4)) return fail(Rie::Range, std::string(name) + " is too small for the basis");
        if (wrap[k] ? n % step : (n - 4) % step)
            diag.report(Severity::Warning, Rie::Consistency, p.place,
                        std::string("PatchMesh: ") + name + " = " + std::to_string(n) + " does not fit the basis step " +
                            std::to_string(step) + "; the last control points are not used");
        dir[k] = NetDirection::cubic(n, wrap[k], b);
    }
    std::vector<std::array<double, 4>> points;
    if (!readControlPoints(s, p.ints[0], p.ints[1], wrap[0], wrap[1], diag, points)) return nullptr;
    return makeNet(std::move(s), std::move(dir[0]), std::move(dir[1]), std::move(points), diag);
}

} // namespace alpenglow::geometry

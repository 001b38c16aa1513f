// Patch "bilinear" or "bicubic".
#include "geometry/control_net.h"
#include "geometry/factories.h"

namespace alpenglow::geometry {

ShapeRef makePatch(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    std::string type = p.strings.empty() ? "" : p.strings[0];
    if (type != "bilinear" && type != "bicubic") {
        diag.report(Severity::Error, Rie::BadToken, p.place,
                    "Patch type \"" + type + "\" is neither \"bilinear\" nor \"bicubic\"; it is not drawn");
        return nullptr;
    }
    bool cubic = type == "bicubic";
    int n = cubic ? 4 : 2;
    std::vector<std::array<double, 4>> points;
    if (!readControlPoints(s, n, n, false, false, diag, points)) return nullptr;
    const scene::Attributes& a = *s.attributes;
    NetDirection u = cubic ? NetDirection::cubic(4, false, a.ubasis) : NetDirection::linear(2, false);
    NetDirection v = cubic ? NetDirection::cubic(4, false, a.vbasis) : NetDirection::linear(2, false);
    return makeNet(std::move(s), std::move(u), std::move(v), std::move(points), diag);
}

} // namespace alpenglow::geometry

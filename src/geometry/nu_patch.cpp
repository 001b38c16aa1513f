// NuPatch nu uorder uknot umin umax nv vorder vknot vmin vmax. Trim curves are not applied.
#include "geometry/control_net.h"
#include "geometry/factories.h"
#include <cmath>

namespace alpenglow::geometry {

ShapeRef makeNuPatch(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    auto fail = [&](Rie code, const std::string& why) -> ShapeRef {
        diag.report(Severity::Error, code, p.place, "NuPatch: " + why + "; it is not drawn");
        return nullptr;
    };
    if (p.ints.size() < 4 || p.numbers.size() < 4) return fail(Rie::MissingData, "counts, orders and ranges are needed");
    // Four control values act along a direction at most: weights() has room for 16.
    constexpr int kOrder = 4;
    NetDirection dir[2];
    int n[2];
    for (size_t k = 0; k < 2; ++k) {
        n[k] = p.ints[2 * k];
        int order = p.ints[2 * k + 1];
        if (order < 2 || n[k] < order)
            return fail(Rie::Range, "there must be at least as many points as the order, which is at least 2");
        if (order > kOrder) return fail(Rie::Unimplement, "orders above 4 are not yet drawn");
        const scene::Param* q = lastParam(p.params, k == 0 ? "uknot" : "vknot");
        size_t need = size_t(n[k]) + size_t(order);
        if (!q || q->numbers.size() < need) return fail(Rie::MissingData, std::to_string(need) + " knots are needed");
        std::vector<double> knots(q->numbers.begin(), q->numbers.begin() + ptrdiff_t(need));
        for (size_t i = 0; i < need; ++i)
            if (!std::isfinite(knots[i]) || (i && knots[i] < knots[i - 1]))
                return fail(Rie::Range, "knots must be finite and must not decrease");
        double first = knots[size_t(order) - 1], last = knots[size_t(n[k])];
        double lo = std::max(double(p.numbers[2 * k]), first), hi = std::min(double(p.numbers[2 * k + 1]), last);
        if (!(lo < hi)) return fail(Rie::Range, "its parameter range is empty");
        dir[k] = NetDirection::nurbs(n[k], order, std::move(knots), lo, hi);
    }
    if (s.attributes->trimCurve) {
        Diagnostic d;
        d.severity = Severity::Warning;
        d.code = Rie::Unimplement;
        d.place = p.place;
        d.message = "trim curves are not yet drawn: NURBS patches are shown whole";
        diag.reportOnce("geometry:trim", d);
    }
    std::vector<std::array<double, 4>> points;
    if (!readControlPoints(s, n[0], n[1], false, false, diag, points)) return nullptr;
    return std::make_shared<ControlNet>(std::move(s), std::move(dir[0]), std::move(dir[1]), std::move(points), diag);
}

} // namespace alpenglow::geometry

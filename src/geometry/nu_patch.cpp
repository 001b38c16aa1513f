// NuPatch nu uorder uknot umin umax nv vorder vknot vmin vmax, with trim curves (trim.h).
#include "base/limits.h"
#include "geometry/control_net.h"
#include "geometry/factories.h"
#include <cmath>

namespace alpenglow::geometry {

namespace {

/// The part of the patch that trim curves keep: null for all. Returns false if nothing is kept.
bool trimOf(const ShapeSource& s, const TrimRegion::Domain& domain, std::shared_ptr<const TrimRegion>& region,
            Diagnostics& diag) {
    const scene::ParamList& curves = *s.attributes->trimCurve;
    const SourcePlace& place = curves.empty() ? s.primitive->place : curves[0].place;
    const scene::Param* sense = s.attributes->value("trimcurve:sense");
    const std::string named = sense && !sense->strings.empty() ? sense->strings[0] : "inside";
    if (named != "inside" && named != "outside") {
        Diagnostic d;
        d.severity = Severity::Error;
        d.code = Rie::BadToken;
        d.place = sense->place;
        d.message =
            "Attribute \"trimcurve\" \"sense\" is \"inside\" or \"outside\", not \"" + named + "\"; the inside is cut away";
        diag.reportOnce("geometry:trimsense:" + named, d);
    }
    std::string why;
    double gap = 0;
    region = TrimRegion::make(curves, domain, named == "outside", why, gap);
    if (!region) {
        diag.report(Severity::Error, Rie::Range, place, "TrimCurve: " + why + "; the NuPatch is drawn completely");
        return true;
    }
    constexpr double kSeen = 1e-3; // of the patch
    if (gap > kSeen)
        diag.report(Severity::Warning, Rie::Consistency, place,
                    "TrimCurve: a loop has a gap of " + std::to_string(gap) + " of the patch between two ends; a line closes it");
    if (region->area() > 0) return true;
    Diagnostic d;
    d.severity = Severity::Warning;
    d.code = Rie::Consistency;
    d.place = s.primitive->place;
    d.message = "NuPatch: its trim curves cut all of it away";
    d.hint = std::string("Attribute \"trimcurve\" \"sense\" \"") + (named == "outside" ? "inside" : "outside") +
             "\" keeps the other part";
    diag.report(std::move(d));
    return false;
}

} // namespace

ShapeRef makeNuPatch(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    auto fail = [&](Rie code, const std::string& why) -> ShapeRef {
        diag.report(Severity::Error, code, p.place, "NuPatch: " + why + "; it is not drawn");
        return nullptr;
    };
    if (p.ints.size() < 4 || p.numbers.size() < 4) return fail(Rie::MissingData, "counts, orders and ranges are needed");
    NetDirection dir[2];
    TrimRegion::Domain domain;
    int n[2];
    for (size_t k = 0; k < 2; ++k) {
        n[k] = p.ints[2 * k];
        int order = p.ints[2 * k + 1];
        if (order < 2 || n[k] < order)
            return fail(Rie::Range, "there must be at least as many points as the order, which is at least 2");
        if (order > limits::kNurbsOrder)
            return fail(Rie::Limit, "orders above " + std::to_string(limits::kNurbsOrder) + " are not drawn");
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
        domain.lo[k] = lo;
        domain.hi[k] = hi;
        dir[k] = NetDirection::nurbs(n[k], order, std::move(knots), lo, hi);
    }
    std::shared_ptr<const TrimRegion> region;
    if (s.attributes->trimCurve && !trimOf(s, domain, region, diag)) return nullptr;
    std::vector<std::array<double, 4>> points;
    if (!readControlPoints(s, n[0], n[1], false, false, diag, points)) return nullptr;
    return makeNet(std::move(s), std::move(dir[0]), std::move(dir[1]), std::move(points), diag, std::move(region));
}

} // namespace alpenglow::geometry

#include "ri/c/filters.h"
#include "base/exact.h"
#include <cmath>

namespace alpenglow::ri {

namespace {

// Those of RISpec 3.2, appendix E, with the corrections of docs/design/sampling.md; the others as their papers have them.

constexpr double kCirclePi = 3.14159265358979323846;

/// The cubic family of Mitchell and Netravali (1988).
double cubicOf(double t, double B, double C) {
    t = std::fabs(t);
    if (t < 1) return ((12 - 9 * B - 6 * C) * t * t * t + (-18 + 12 * B + 6 * C) * t * t + (6 - 2 * B)) / 6;
    if (t < 2) return ((-B - 6 * C) * t * t * t + (6 * B + 30 * C) * t * t + (-12 * B - 48 * C) * t + (8 * B + 24 * C)) / 6;
    return 0;
}

double sincOf(double t) { return std::fabs(t) < 1e-6 ? 1 : exact::sin(kCirclePi * t) / (kCirclePi * t); }

double blackmanHarris(double t, double w) {
    const double a = 2 * kCirclePi * (t / w + 0.5);
    return 0.35875 - 0.48829 * exact::cos(a) + 0.14128 * exact::cos(2 * a) - 0.01168 * exact::cos(3 * a);
}

/// Bessel function of the first kind, order 1: (1/pi) int_0^pi cos(t - x sin t) dt by the trapezoid rule, which converges
/// exponentially because the integrand is even and periodic.
double besselOf(double x) {
    const int n = 24 + int(std::fabs(x));
    double sum = 0;
    for (int i = 1; i < n; ++i) sum += exact::cos(kCirclePi * i / n - x * exact::sin(kCirclePi * i / n));
    return sum / n; // the ends cancel: cos(0) + cos(pi)
}

bool inside(double x, double y, double xw, double yw) { return std::fabs(x) <= xw / 2 && std::fabs(y) <= yw / 2; }

struct KnownFilter {
    RtFilterFunc function;
    const char* name;
};
constexpr KnownFilter kKnownFilters[] = {{RiBoxFilter, "box"},
                                         {RiTriangleFilter, "triangle"},
                                         {RiCatmullRomFilter, "catmull-rom"},
                                         {RiSeparableCatmullRomFilter, "separable-catmull-rom"},
                                         {RiGaussianFilter, "gaussian"},
                                         {RiSincFilter, "sinc"},
                                         {RiBesselFilter, "bessel"},
                                         {RiDiskFilter, "disk"},
                                         {RiMitchellFilter, "mitchell"},
                                         {RiBlackmanHarrisFilter, "blackman-harris"},
                                         {RiLanczosFilter, "lanczos"}};

/// Whether two functions are the same but for a factor, which drops out of filtering.
bool sameFilter(RtFilterFunc a, RtFilterFunc b, RtFloat xw, RtFloat yw) {
    constexpr int kSteps = 16;
    constexpr double kSame = 1e-3;
    const double middle[2] = {a(0, 0, xw, yw), b(0, 0, xw, yw)};
    if (!(std::fabs(middle[0]) > 0) || !(std::fabs(middle[1]) > 0)) return false;
    for (int i = -kSteps; i <= kSteps; ++i)
        for (int k = -kSteps; k <= kSteps; ++k) {
            // Not at the rim, where one is zero already and the other not yet.
            const RtFloat x = RtFloat(i * 0.49 / kSteps) * xw, y = RtFloat(k * 0.49 / kSteps) * yw;
            if (!(std::fabs(a(x, y, xw, yw) / middle[0] - b(x, y, xw, yw) / middle[1]) <= kSame)) return false;
        }
    return true;
}

} // namespace

Building& filterName(Building& b, RtFilterFunc filter, RtFloat xw, RtFloat yw) {
    if (!b.may(1, {reinterpret_cast<const void*>(filter)})) return b;
    for (const KnownFilter& k : kKnownFilters)
        if (k.function == filter) return b.text(k.name);
    if (xw > 0 && yw > 0)
        for (const KnownFilter& k : kKnownFilters)
            if (sameFilter(filter, k.function, xw, yw)) return b.text(k.name);
    b.report(Severity::Error, Rie::Incapable, "filter functions of a program's own are not used: gaussian is, of the same widths",
             "RiBoxFilter, RiTriangleFilter, RiCatmullRomFilter, RiGaussianFilter, RiSincFilter and the others of ri.h");
    return b.text("gaussian");
}

} // namespace alpenglow::ri

using namespace alpenglow;
using namespace alpenglow::ri;

extern "C" {

RtFloat RiBoxFilter(RtFloat, RtFloat, RtFloat, RtFloat) { return 1; }
RtFloat RiTriangleFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    if (!inside(x, y, xw, yw)) return 0;
    return RtFloat((1 - std::fabs(double(x)) / (xw / 2)) * (1 - std::fabs(double(y)) / (yw / 2)));
}
RtFloat RiCatmullRomFilter(RtFloat x, RtFloat y, RtFloat, RtFloat) {
    return RtFloat(2 * cubicOf(std::sqrt(double(x) * x + double(y) * y), 0, 0.5));
}
RtFloat RiSeparableCatmullRomFilter(RtFloat x, RtFloat y, RtFloat, RtFloat) {
    return RtFloat(cubicOf(x, 0, 0.5) * cubicOf(y, 0, 0.5));
}
RtFloat RiGaussianFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    const double u = 2 * double(x) / xw, v = 2 * double(y) / yw;
    return RtFloat(exact::exp(-2 * (u * u + v * v)));
}
RtFloat RiSincFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    if (!inside(x, y, xw, yw)) return 0;
    return RtFloat(sincOf(x) * exact::cos(kCirclePi * x / (2 * xw)) * sincOf(y) * exact::cos(kCirclePi * y / (2 * yw)));
}
RtFloat RiDiskFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    const double u = 2 * double(x) / xw, v = 2 * double(y) / yw;
    return u * u + v * v < 1 ? RtFloat(1) : RtFloat(0);
}
RtFloat RiBesselFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    const double u = 2 * double(x) / xw, v = 2 * double(y) / yw, q = u * u + v * v;
    const double r = std::sqrt(double(x) * x + double(y) * y);
    if (q >= 1) return 0;
    return RtFloat(r < 1e-8 ? kCirclePi : exact::cos(kCirclePi / 2 * std::sqrt(q)) * 2 * besselOf(kCirclePi * r) / r);
}
RtFloat RiMitchellFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    return RtFloat(cubicOf(4 * x / xw, 1.0 / 3, 1.0 / 3) * cubicOf(4 * y / yw, 1.0 / 3, 1.0 / 3));
}
RtFloat RiBlackmanHarrisFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    return inside(x, y, xw, yw) ? RtFloat(blackmanHarris(x, xw) * blackmanHarris(y, yw)) : RtFloat(0);
}
RtFloat RiLanczosFilter(RtFloat x, RtFloat y, RtFloat xw, RtFloat yw) {
    if (!inside(x, y, xw, yw)) return 0;
    return RtFloat(sincOf(x) * sincOf(2 * x / xw) * sincOf(y) * sincOf(2 * y / yw));
}

} // extern "C"

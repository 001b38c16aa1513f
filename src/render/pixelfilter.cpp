#include "render/pixelfilter.h"
#include "base/exact.h"
#include "base/filternames.h"
#include "base/limits.h"
#include "base/vec.h"
#include <cmath>
#include <string>
#include <vector>

namespace alpenglow::render {
namespace {

constexpr const char* kNames[kFilterKinds] = {
    "box",    "triangle", "catmull-rom", "separable-catmull-rom", "b-spline", "gaussian", "sinc",
    "bessel", "disk",     "mitchell",    "blackman-harris",       "lanczos"};

// The cubic family of Mitchell and Netravali, "Reconstruction filters in computer graphics" (1988); support |t| < 2.
double cubicBC(double t, double B, double C) {
    t = std::fabs(t);
    if (t < 1) return ((12 - 9 * B - 6 * C) * t * t * t + (-18 + 12 * B + 6 * C) * t * t + (6 - 2 * B)) / 6;
    if (t < 2) return ((-B - 6 * C) * t * t * t + (6 * B + 30 * C) * t * t + (-12 * B - 48 * C) * t + (8 * B + 24 * C)) / 6;
    return 0;
}

double sinc(double x) {
    // Below 1e-4 the series is exact to double precision and the quotient is not.
    double p = kPi * x;
    return std::fabs(p) < 1e-4 ? 1 - p * p / 6 : exact::sin(p) / p;
}

// Bessel function of the first kind, order 1, from its integral (1/pi) int_0^pi cos(t - x sin t) dt: the integrand is even and
// 2 pi periodic, so the trapezoid rule converges exponentially and needs little more than |x| nodes. (Not std::cyl_bessel_j:
// some C++ libraries lack it.)
double besselJ1(double x) {
    int n = 24 + int(std::fabs(x));
    double sum = 0.5 * (1 + exact::cos(kPi));
    for (int i = 1; i < n; ++i) {
        double t = kPi * i / n;
        sum += exact::cos(t - x * exact::sin(t));
    }
    return sum / n;
}

} // namespace

const char* filterName(FilterKind k) { return kNames[int(k)]; }

std::optional<FilterKind> filterByName(std::string_view name) {
    const std::string same = filterNameOf(name);
    for (int i = 0; i < kFilterKinds; ++i)
        if (same == kNames[i]) return FilterKind(i);
    return {};
}

bool PixelFilter::separable() const {
    return kind != FilterKind::CatmullRom && kind != FilterKind::Bessel && kind != FilterKind::Disk;
}

double PixelFilter::axis(double t, double w) const {
    t = std::fabs(t);
    if (!(t <= w / 2)) return 0;
    switch (kind) {
    case FilterKind::Triangle:
        return 1 - t / (w / 2);
    case FilterKind::SeparableCatmullRom:
        return cubicBC(t, 0, 0.5);
    case FilterKind::BSpline:
        return cubicBC(4 * t / w, 1, 0); // support 2 mapped to the half width, as for mitchell
    case FilterKind::Gaussian:
        return exact::exp(-8 * t * t / (w * w));
    case FilterKind::Sinc:
        return sinc(t) * exact::cos(kPi * t / (2 * w));
    case FilterKind::Mitchell:
        return cubicBC(4 * t / w, 1.0 / 3, 1.0 / 3);
    case FilterKind::BlackmanHarris: {
        double a = 2 * kPi * (t / w + 0.5);
        return 0.35875 - 0.48829 * exact::cos(a) + 0.14128 * exact::cos(2 * a) - 0.01168 * exact::cos(3 * a);
    }
    case FilterKind::Lanczos:
        return sinc(t) * sinc(2 * t / w);
    default:
        return 1;
    }
}

double PixelFilter::operator()(double x, double y) const {
    if (!(std::fabs(x) <= xw / 2 && std::fabs(y) <= yw / 2)) return 0;
    if (separable()) return axis(x, xw) * axis(y, yw);
    double r = std::sqrt(x * x + y * y), q = (2 * x / xw) * (2 * x / xw) + (2 * y / yw) * (2 * y / yw);
    if (kind == FilterKind::CatmullRom) return 2 * cubicBC(r, 0, 0.5); // RISpec has twice the usual kernel; the factor cancels
    if (q >= 1) return 0;
    if (kind == FilterKind::Disk) return 1;
    return r < 1e-8 ? kPi : exact::cos(kPi / 2 * std::sqrt(q)) * 2 * besselJ1(kPi * r) / r;
}

PixelFilter makePixelFilter(std::string_view name, double xw, double yw, const SourcePlace& place, Diagnostics& diag) {
    PixelFilter f;
    if (auto k = filterByName(name)) f.kind = *k;
    else {
        std::string near = nearestName(name, std::vector<std::string>(kNames, kNames + kFilterKinds));
        diag.report(Severity::Error, Rie::BadToken, place, "unknown pixel filter \"" + std::string(name) + "\"; gaussian is used",
                    near.empty() ? "" : "did you mean \"" + near + "\"?");
    }
    auto width = [&](double w, const char* which) {
        if (w > 0 && w <= limits::kFilterWidth) return w;
        double use = w > 0 ? limits::kFilterWidth : 1;
        diag.report(Severity::Error, Rie::Range, place,
                    std::string("pixel filter ") + which + " width " + std::to_string(w) + " is outside (0, " +
                        std::to_string(int(limits::kFilterWidth)) + "]; " + std::to_string(int(use)) + " is used");
        return use;
    };
    f.xw = width(xw, "x");
    f.yw = width(yw, "y");
    return f;
}

} // namespace alpenglow::render

#include "base/exact.h"
#include "base/exactseries.h"
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace alpenglow::exact {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
// ln 2 in two parts.
constexpr double kLn2 = 0x1.62e42feep-1, kLn2Lo = 0x1.a39ef35793c76p-33;

/// atan(small / large) for 0 <= small <= large, large > 0: nearest table entry plus the remaining angle by series.
double atanOfQuotient(double small, double large) {
    const double ratio = small / large;
    const int k = int(16 * ratio + 0.5);
    const double c = k / 16., z = k == 0 ? ratio : (small - c * large) / (large + c * small);
    return kAtan[k] + (z + (kAtanLo[k] - z * atanSeries(z)));
}
/// x * 2^k, |k| <= 2000.
double scaled(double x, int k) {
    const auto power = [](int e) { return std::bit_cast<double>(uint64_t(e + 1023) << 52); };
    for (; k > 1000; k -= 1000) x *= power(1000);
    for (; k < -1000; k += 1000) x *= power(-1000);
    return x * power(k);
}
} // namespace

SinCos sinCos(double x) {
    if (!(std::fabs(x) <= 1e6)) {
        if (!(std::fabs(x) < kInfinity)) return {kNaN, kNaN};
        x = std::fmod(x, 4 * kHalfPi); // exact
    }
    const double turns = std::nearbyint(x * (1 / kHalfPi));
    const double r = ((x - turns * kHalfPi1) - turns * kHalfPi2) - turns * kHalfPi3;
    const double s = sineNear(r), c = cosineNear(r);
    const int k = int(turns) & 3;
    const double a = k & 1 ? c : s, b = k & 1 ? s : c;
    return {k & 2 ? -a : a, (k + 1) & 2 ? -b : b};
}
double sin(double x) { return sinCos(x).sin; }
double cos(double x) { return sinCos(x).cos; }
double tan(double x) {
    const SinCos v = sinCos(x);
    return v.sin / v.cos;
}

double atan2(double y, double x) {
    double ax = std::fabs(x), ay = std::fabs(y);
    if (!(ax < kInfinity && ay < kInfinity)) return kNaN;
    double large = ax > ay ? ax : ay, small = ax > ay ? ay : ax, r = 0;
    if (large > 0) {
        if (large > 0x1p1000) large *= 0x1p-100, small *= 0x1p-100;
        if (large < 0x1p-900) large *= 0x1p200, small *= 0x1p200;
        r = atanOfQuotient(small, large);
    }
    if (ay > ax) r = kHalfPi - (r - kHalfPiLo);
    if (std::signbit(x)) r = 2 * kHalfPi - (r - 2 * kHalfPiLo);
    return std::copysign(r, y);
}
double atan(double x) { return std::fabs(x) < kInfinity ? atan2(x, 1) : std::copysign(kHalfPi, x); }
double asin(double x) { return std::fabs(x) <= 1 ? atan2(x, std::sqrt((1 - x) * (1 + x))) : kNaN; }
double acos(double x) { return std::fabs(x) <= 1 ? atan2(std::sqrt((1 - x) * (1 + x)), x) : kNaN; }

double exp(double x) {
    if (!(x <= 709.782712893384)) return x > 0 ? kInfinity : kNaN;
    if (x < -745.2) return 0;
    const double k = std::nearbyint(x * (1 / (kLn2 + kLn2Lo)));
    const double r = (x - k * kLn2) - k * kLn2Lo;
    // Series from r^2 / 2 on, in four parallel chains.
    const double q = r * r, w = q * q, v = w * w;
    const double a = (0.5 + r * (1 / 6.)) + q * (1 / 24. + r * (1 / 120.)),
                 b = (1 / 720. + r * (1 / 5040.)) + q * (1 / 40320. + r * (1 / 362880.));
    const double c = (1 / 3628800. + r * (1 / 39916800.)) + q * (1 / 479001600. + r * (1 / 6227020800.));
    const double p = a + (w * b + v * c);
    return scaled(1 + (r + r * r * p), int(k));
}

double log(double x) {
    if (!(x > 0)) return x == 0 ? -kInfinity : kNaN;
    if (!(x < kInfinity)) return x;
    int e = 0;
    if (x < 0x1p-1000) x *= 0x1p100, e = -100;
    // x = m 2^e with sqrt(1/2) <= m < sqrt(2).
    const uint64_t bits = std::bit_cast<uint64_t>(x), above = bits - 0x3fe6a09e667f3bcdull;
    const int step = int(int64_t(above) >> 52);
    e += step;
    const double f = std::bit_cast<double>(bits - (uint64_t(step) << 52)) - 1;
    const double s = f / (2 + f), q = s * s;
    const double w = q * q, v = w * w;
    const double low = (2 / 3. + q * (2 / 5.)) + w * (2 / 7. + q * (2 / 9.)),
                 high = (2 / 11. + q * (2 / 13.)) + w * (2 / 15. + q * (2 / 17.));
    const double series = low + v * (high + v * (2 / 19. + q * (2 / 21.)));
    return e * kLn2 - ((s * (f - series * q) - e * kLn2Lo) - f);
}

double pow(double x, double y) {
    if (y == 0) return 1;
    if (!(x > 0)) return x == 0 ? (y > 0 ? 0 : kInfinity) : kNaN;
    return exp(y * log(x));
}

} // namespace alpenglow::exact

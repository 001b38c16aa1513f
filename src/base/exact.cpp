#include "base/exact.h"
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace alpenglow::exact {

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();
// pi / 2 in parts of 33 bits, so that products with whole numbers below 2^20 are exact; ln 2 in two parts.
constexpr double kHalfPi1 = 0x1.921fb544p+0, kHalfPi2 = 0x1.0b4611a6p-34, kHalfPi3 = 0x1.3198a2e037073p-69;
constexpr double kHalfPi = 0x1.921fb54442d18p+0, kHalfPiLo = 0x1.1a62633145c07p-54;
constexpr double kLn2 = 0x1.62e42feep-1, kLn2Lo = 0x1.a39ef35793c76p-33;

/// sin and cos for |r| <= pi / 4 by their series, as exact as the type is; their even and odd terms apart, so that they run side
/// by side.
double sineNear(double r) {
    const double q = r * r, w = q * q;
    const double even = 1 / 120. + w * (1 / 362880. + w * (1 / 6227020800. + w * (1 / 355687428096000.)));
    const double odd = 1 / 5040. + w * (1 / 39916800. + w * (1 / 1307674368000.));
    return r - r * q * (1 / 6. - q * (even - q * odd));
}
double cosineNear(double r) {
    const double q = r * r, w = q * q;
    const double even = 1 / 24. + w * (1 / 40320. + w * (1 / 479001600. + w * (1 / 20922789888000.)));
    const double odd = 1 / 720. + w * (1 / 3628800. + w * (1 / 87178291200. + w * (1 / 6402373705728000.)));
    const double h = 0.5 * q, c = 1 - h;
    return c + (((1 - c) - h) + w * (even - q * odd));
}

/// atan(k / 16), rounded, and what is missing.
constexpr double kAtan[17] = {0,
                              0x1.ff55bb72cfdeap-5,
                              0x1.fd5ba9aac2f6ep-4,
                              0x1.7b97b4bce5b02p-3,
                              0x1.f5b75f92c80ddp-3,
                              0x1.362773707ebccp-2,
                              0x1.6f61941e4def1p-2,
                              0x1.a64eec3cc23fdp-2,
                              0x1.dac670561bb4fp-2,
                              0x1.0657e94db30d0p-1,
                              0x1.1e00babdefeb4p-1,
                              0x1.345f01cce37bbp-1,
                              0x1.4978fa3269ee1p-1,
                              0x1.5d58987169b18p-1,
                              0x1.700a7c5784634p-1,
                              0x1.819d0b7158a4dp-1,
                              0x1.921fb54442d18p-1};
constexpr double kAtanLo[17] = {0,
                                -0x1.c934d86d23f1dp-60,
                                -0x1.cd37686760c17p-59,
                                0x1.347b0b4f881cap-58,
                                0x1.8ab6e3cf7afbdp-57,
                                -0x1.963a544b672d8p-57,
                                -0x1.c63aae6f6e918p-56,
                                -0x1.24dec1b50b7ffp-56,
                                0x1.a2b7f222f65e2p-56,
                                -0x1.d5b495f6349e6p-56,
                                -0x1.928df287a668fp-58,
                                0x1.1021137c71102p-55,
                                0x1.2419a87f2a458p-56,
                                0x1.0028e4bc5e7cap-57,
                                -0x1.8c34d25aadef6p-56,
                                -0x1.bf76229d3b917p-56,
                                0x1.1a62633145c07p-55};

/// atan(small / large) for 0 <= small <= large, large > 0: from the nearest of the table, with the angle between by its series.
double atanOfQuotient(double small, double large) {
    const double ratio = small / large;
    const int k = int(16 * ratio + 0.5);
    const double c = k / 16., z = k == 0 ? ratio : (small - c * large) / (large + c * small);
    const double q = z * z;
    const double series = q * (1 / 3. - q * (1 / 5. - q * (1 / 7. - q * (1 / 9. - q * (1 / 11. - q * (1 / 13.))))));
    return kAtan[k] + (z + (kAtanLo[k] - z * series));
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
    // Of the series from r^2 / 2 on, four chains side by side.
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

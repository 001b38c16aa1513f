// base/exact.h against the library's longer type (64 bits of mantissa on x86), over ranges that pictures meet and odd numbers.
#include "base/exact.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace exact_test {

namespace {
using namespace alpenglow;
using Long = long double;
constexpr double kPi = 3.14159265358979323846;

/// Error in units of the last place of the wanted number (of `least` where it is smaller).
double ulps(double got, Long want, double least = 0x1p-1022) {
    const double scale = std::max(std::fabs(double(want)), least);
    return double(std::fabs(Long(got) - want) / Long(std::nextafter(scale, 2 * scale) - scale));
}
template <class Got, class Want>
double worst(double low, double high, const Got& got, const Want& want, double least = 0x1p-1022) {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> range(low, high);
    double most = 0;
    for (int i = 0; i < 200000; ++i) {
        const double x = range(random);
        most = std::max(most, ulps(got(x), want(Long(x)), least));
    }
    return most;
}

TEST(Exact, SineAndCosine) {
    static_assert(std::numeric_limits<Long>::digits >= 64);
    for (double range : {0.8, 7., 1e3, 1e6}) {
        EXPECT_LT(worst(-range, range, exact::sin, [](Long x) { return std::sin(x); }), range < 1e6 ? 1.5 : 2.5) << range;
        EXPECT_LT(worst(-range, range, exact::cos, [](Long x) { return std::cos(x); }), range < 1e6 ? 1.5 : 2.5) << range;
        EXPECT_LT(worst(-range, range, exact::tan, [](Long x) { return std::tan(x); }), range < 1e6 ? 3 : 4) << range;
    }
    // Near multiples of pi / 2 all digits count.
    for (int k = -3000; k <= 3000; ++k) {
        const double x = k * (kPi / 2);
        EXPECT_LT(ulps(exact::sin(x), std::sin(Long(x))), 1.5) << k;
        EXPECT_LT(ulps(exact::cos(x), std::cos(Long(x))), 1.5) << k;
    }
    EXPECT_EQ(exact::sin(0), 0);
    EXPECT_EQ(exact::cos(0), 1);
    EXPECT_LE(std::fabs(exact::sin(1e300)), 1);
    EXPECT_TRUE(std::isnan(exact::sin(INFINITY)) && std::isnan(exact::cos(NAN)));
}

TEST(Exact, ArcTangents) {
    std::mt19937_64 random(12);
    std::normal_distribution<double> normal;
    double most = 0;
    for (int i = 0; i < 400000; ++i) {
        const double scale = std::pow(10, normal(random) * 30), y = normal(random) * scale,
                     x = normal(random) * scale * (i & 1 ? 1 : 1e-3);
        most = std::max(most, ulps(exact::atan2(y, x), std::atan2(Long(y), Long(x))));
    }
    EXPECT_LT(most, 1.5);
    for (double y : {0., -0., 1., -1., 3e-320, 1e308})
        for (double x : {0., -0., 1., -1., 3e-320, -1e308}) {
            const double got = exact::atan2(y, x), want = std::atan2(y, x);
            EXPECT_NEAR(got, want, 1e-15) << y << " " << x;
            EXPECT_EQ(std::signbit(got), std::signbit(want)) << y << " " << x;
        }
    EXPECT_EQ(exact::atan2(1, 0), kPi / 2);
    EXPECT_EQ(exact::atan2(0, -1), kPi);
    EXPECT_EQ(exact::asin(1), kPi / 2);
    EXPECT_EQ(exact::asin(-1), -kPi / 2);
    EXPECT_EQ(exact::acos(-1), kPi);
    EXPECT_LT(worst(-1, 1, exact::asin, [](Long x) { return std::asin(x); }), 3);
    EXPECT_LT(worst(-1, 1, exact::acos, [](Long x) { return std::acos(x); }, 1), 3);
    EXPECT_LT(worst(-40, 40, exact::atan, [](Long x) { return std::atan(x); }), 1.5);
    EXPECT_EQ(exact::atan(INFINITY), kPi / 2);
    EXPECT_TRUE(std::isnan(exact::asin(1.1)) && std::isnan(exact::atan2(NAN, 1)));
}

TEST(Exact, ExponentialsAndLogarithms) {
    for (double range : {1., 40., 700.})
        EXPECT_LT(worst(-range, range, exact::exp, [](Long x) { return std::exp(x); }), 1.5) << range;
    for (double range : {1.1, 2., 1e3, 1e300})
        EXPECT_LT(worst(1e-9, range, exact::log, [](Long x) { return std::log(x); }), 1.5) << range;
    EXPECT_LT(worst(0.99, 1.01, exact::log, [](Long x) { return std::log(x); }), 1.5);
    for (double y : {1 / 2.4, 2.4, 2.2, -3.5, 40.})
        EXPECT_LT(worst(
                      1e-4, 20, [&](double x) { return exact::pow(x, y); }, [&](Long x) { return std::pow(x, Long(y)); }),
                  2 + 10 * std::fabs(y))
            << y;
    EXPECT_EQ(exact::exp(0), 1);
    EXPECT_EQ(exact::exp(1e9), INFINITY);
    EXPECT_EQ(exact::exp(-1e9), 0);
    EXPECT_NEAR(exact::exp(-740) / std::exp(-740), 1, 1e-2);
    EXPECT_EQ(exact::log(1), 0);
    EXPECT_EQ(exact::log(0), -INFINITY);
    EXPECT_NEAR(exact::log(1e-315), std::log(1e-315), 1e-12);
    EXPECT_TRUE(std::isnan(exact::log(-1)) && std::isnan(exact::pow(-1, 2)) && std::isnan(exact::exp(NAN)));
    EXPECT_EQ(exact::pow(0, 2), 0);
    EXPECT_EQ(exact::pow(0, 0), 1);
    EXPECT_EQ(exact::pow(3, 1), exact::exp(exact::log(3)));
}
} // namespace

} // namespace exact_test

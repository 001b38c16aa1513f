// Errors of the elementary functions in ulp against the C library in double, over their ranges; and the edge rules of
// 3Delight manual, 6.4.1.
#include "shadeops/descriptor.h"
#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace elementary_test {

using namespace alpenglow::shadeops;

namespace {

float call(const char* symbol, float x) {
    float r = NAN;
    EXPECT_TRUE(evaluateRuntime(symbol, &x, 1, &r, 1)) << symbol;
    return r;
}
float call(const char* symbol, float x, float y) {
    const float in[] = {x, y};
    float r = NAN;
    EXPECT_TRUE(evaluateRuntime(symbol, in, 2, &r, 1)) << symbol;
    return r;
}

/// Distance in units of the last place of the exact result (never below those of the smallest normal float).
double ulps(float got, double exact) {
    int exponent;
    std::frexp(std::max(std::abs(exact), 0x1p-126), &exponent);
    return std::abs(got - exact) / std::ldexp(1.0, exponent - 24);
}

struct Row {
    const char* symbol;
    double (*exact)(double);
    float lo, hi;
    double most;
};

TEST(Elementary, UlpOverRanges) {
    const Row rows[] = {
        {"al_sin", [](double x) { return std::sin(x); }, -7, 7, 2},
        {"al_sin", [](double x) { return std::sin(x); }, -1e5f, 1e5f, 2},
        {"al_cos", [](double x) { return std::cos(x); }, -7, 7, 2},
        {"al_cos", [](double x) { return std::cos(x); }, -1e5f, 1e5f, 2},
        {"al_tan", [](double x) { return std::tan(x); }, -7, 7, 4},
        {"al_tan", [](double x) { return std::tan(x); }, -1e5f, 1e5f, 4},
        {"al_asin", [](double x) { return std::asin(x); }, -1, 1, 3},
        {"al_acos", [](double x) { return std::acos(x); }, -1, 1, 3},
        {"al_atan", [](double x) { return std::atan(x); }, -1, 1, 3},
        {"al_atan", [](double x) { return std::atan(x); }, -1000, 1000, 3},
        {"al_exp", [](double x) { return std::exp(x); }, -86.5f, 88.7f, 2},
        {"al_exp", [](double x) { return std::exp(x); }, -1, 1, 2},
        {"al_log", [](double x) { return std::log(x); }, 0.5f, 2, 2},
        {"al_log", [](double x) { return std::log(x); }, 1e-30f, 1e-20f, 2},
        {"al_log", [](double x) { return std::log(x); }, 1, 1e9f, 2},
        {"al_sqrt", [](double x) { return std::sqrt(x); }, 0, 1e6f, 0.5001},
        {"al_inversesqrt", [](double x) { return 1 / std::sqrt(x); }, 1e-6f, 1e6f, 1.5},
        {"al_radians", [](double x) { return x * M_PI / 180; }, -720, 720, 1.5},
        {"al_degrees", [](double x) { return x * 180 / M_PI; }, -7, 7, 1.5},
    };
    for (const Row& row : rows) {
        double worst = 0;
        float at = 0;
        const int n = 100000;
        for (int i = 0; i <= n; ++i) {
            const float x = static_cast<float>(row.lo + (static_cast<double>(row.hi) - row.lo) * i / n);
            const double e = ulps(call(row.symbol, x), row.exact(x));
            if (!(e <= worst)) {
                worst = e;
                at = x;
            }
        }
        EXPECT_LE(worst, row.most) << row.symbol << " at " << at;
        RecordProperty(std::string(row.symbol) + std::to_string(row.hi), std::to_string(worst));
        std::printf("%-14s [%g, %g]: %.2f ulp at %.9g\n", row.symbol, row.lo, row.hi, worst, at);
    }
}

TEST(Elementary, PowUlp) {
    std::mt19937 random(5);
    const auto draw = [&](double lo, double hi) {
        return static_cast<float>(lo + (hi - lo) * std::generate_canonical<double, 32>(random));
    };
    double worst = 0, worstAll = 0;
    for (int i = 0; i < 200000; ++i) {
        const float x = std::exp2(draw(-20, 20)), y = draw(-5, 5);
        const double exact = std::pow(static_cast<double>(x), static_cast<double>(y)), bits = std::abs(y * std::log2(x));
        if (!(exact > 1e-37 && exact < 3e38)) continue;
        const double e = ulps(call("al_pow", x, y), exact);
        worstAll = std::max(worstAll, e);
        if (bits < 16) worst = std::max(worst, e);
    }
    EXPECT_LE(worst, 2.5);
    EXPECT_LE(worstAll, 4);
    double steep = 0; // near 1 with large exponents: specular highlights
    for (int i = 0; i < 100000; ++i) {
        const float x = draw(0.7, 1.3), y = draw(-200, 200);
        const double exact = std::pow(static_cast<double>(x), static_cast<double>(y));
        if (exact > 1e-37 && exact < 3e38) steep = std::max(steep, ulps(call("al_pow", x, y), exact));
    }
    EXPECT_LE(steep, 12);
    std::printf("pow: %.2f ulp below 2^16, %.2f everywhere, %.2f near 1\n", worst, worstAll, steep);
}

TEST(Elementary, Atan2Ulp) {
    std::mt19937 random(6);
    double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        const float y = -4 + 8 * std::generate_canonical<float, 24>(random),
                    x = -4 + 8 * std::generate_canonical<float, 24>(random);
        worst = std::max(worst, ulps(call("al_atan2", y, x), std::atan2(static_cast<double>(y), static_cast<double>(x))));
    }
    EXPECT_LE(worst, 3);
    std::printf("atan2: %.2f ulp\n", worst);
}

// 3Delight manual, 6.4.1, edge rules.
TEST(Elementary, EdgeRules) {
    EXPECT_EQ(call("al_sqrt", -1), 0);
    EXPECT_EQ(call("al_inversesqrt", 0), 1e38f);
    EXPECT_EQ(call("al_inversesqrt", -4), 1e38f);
    EXPECT_EQ(call("al_log", 0), -INFINITY);
    EXPECT_EQ(call("al_log", -1), -INFINITY);
    EXPECT_FLOAT_EQ(call("al_asin", 2), static_cast<float>(M_PI / 2));
    EXPECT_FLOAT_EQ(call("al_acos", -3), static_cast<float>(M_PI));
    EXPECT_EQ(call("al_sign", 0), 1);
    EXPECT_EQ(call("al_sign", -0.5f), -1);
    EXPECT_EQ(call("al_mod", -1, 3), 2);
    EXPECT_EQ(call("al_mod", 7.5f, 3), 1.5f);
    EXPECT_EQ(call("al_mod", 1, 0), 0);
    EXPECT_EQ(call("al_round", 2.5f), 3);
    EXPECT_EQ(call("al_round", -2.5f), -3);
    EXPECT_EQ(call("al_round", 0.49999997f), 0);
    EXPECT_EQ(call("al_round", 8388609.0f), 8388609.0f);
    EXPECT_EQ(call("al_pow", -2, 3), -8);
    EXPECT_EQ(call("al_pow", -2, 2), 4);
    EXPECT_EQ(call("al_pow", -2, 0.5f), 0);
    EXPECT_EQ(call("al_pow", 0, 0), 1);
    EXPECT_EQ(call("al_pow", 0, 2), 0);
    EXPECT_EQ(call("al_pow", 2, 10), 1024);
    EXPECT_EQ(call("al_pow", 2, 200), INFINITY);
    EXPECT_EQ(call("al_pow", 2, -200), 0);
    EXPECT_EQ(call("al_exp", 0), 1);
    EXPECT_EQ(call("al_exp", 100), INFINITY);
    EXPECT_EQ(call("al_exp", -100), 0);
    EXPECT_EQ(call("al_atan2", 0, 0), 0);
    EXPECT_FLOAT_EQ(call("al_atan2", 0, -1), static_cast<float>(M_PI));
    EXPECT_EQ(call("al_logbase", 8, 2), 3);
    EXPECT_EQ(call("al_sin", 0), 0);
    EXPECT_EQ(call("al_cos", 0), 1);
    for (const float x : {1e6f, 1e8f, 1e20f, 3e38f, INFINITY}) {
        EXPECT_LE(std::abs(call("al_sin", x)), 1) << x;
        EXPECT_LE(std::abs(call("al_cos", x)), 1) << x;
    }
}

TEST(Elementary, ModStaysInRange) {
    std::mt19937 random(7);
    for (int i = 0; i < 100000; ++i) {
        const float x = -1000 + 2000 * std::generate_canonical<float, 24>(random),
                    y = 0.01f + 5 * std::generate_canonical<float, 24>(random);
        const float r = call("al_mod", x, y);
        ASSERT_GE(r, 0) << x << " " << y;
        ASSERT_LE(r, y) << x << " " << y;
        const double n = (static_cast<double>(x) - r) / y;
        ASSERT_NEAR(n, std::round(n), 1e-3) << x << " " << y;
    }
}

} // namespace

} // namespace elementary_test

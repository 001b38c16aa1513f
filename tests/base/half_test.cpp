#include "base/half.h"
#include <cmath>
#include <gtest/gtest.h>

namespace alpenglow {
namespace {

/// By the definition of binary16.
double valueOf(uint16_t h) {
    const double sign = h & 0x8000 ? -1 : 1;
    const int e = h >> 10 & 31, m = h & 1023;
    if (e == 31) return m ? NAN : sign * INFINITY;
    return sign * (e == 0 ? std::ldexp(m, -24) : std::ldexp(1024 + m, e - 25));
}

TEST(Half, AllOfThemComeBack) {
    for (uint32_t h = 0; h < 65536; ++h) {
        const double v = valueOf(uint16_t(h));
        if (std::isnan(v)) EXPECT_TRUE(std::isnan(valueOf(toHalf(float(v)))) && std::isnan(ofHalf(uint16_t(h))));
        else {
            ASSERT_EQ(toHalf(float(v)), h);
            ASSERT_EQ(double(ofHalf(uint16_t(h))), v);
        }
    }
}

TEST(Half, TheNearestIsTakenAndTiesAreEven) {
    for (uint16_t h = 0; h < 0x7bff; ++h) { // between each two neighbours
        const double a = valueOf(h), b = valueOf(uint16_t(h + 1)), middle = (a + b) / 2;
        ASSERT_EQ(toHalf(float(middle)), h % 2 ? h + 1 : h) << h;
        ASSERT_EQ(toHalf(std::nextafter(float(middle), 0.f)), h) << h;
        ASSERT_EQ(toHalf(std::nextafter(float(middle), 1e9f)), h + 1) << h;
        ASSERT_EQ(toHalf(-float(middle)), (h % 2 ? h + 1 : h) | 0x8000) << h;
    }
    EXPECT_EQ(toHalf(65519.f), 0x7bff);
    EXPECT_EQ(toHalf(65520.f), 0x7c00);
    EXPECT_EQ(toHalf(1e38f), 0x7c00);
    EXPECT_EQ(toHalf(-INFINITY), 0xfc00);
    EXPECT_EQ(toHalf(1e-9f), 0);
}

} // namespace
} // namespace alpenglow

#include "base/srgb.h"
#include <gtest/gtest.h>

namespace srgb_test {

using namespace alpenglow;

// IEC 61966-2-1: the codes of some greys, as published in tables of the standard's curve.
TEST(Srgb, KnownValues) {
    EXPECT_FLOAT_EQ(srgbEncode(0), 0);
    EXPECT_NEAR(srgbEncode(1), 1, 1e-6);
    EXPECT_NEAR(srgbEncode(0.5f), 0.735357f, 1e-5);
    EXPECT_NEAR(srgbEncode(0.18f), 0.461356f, 1e-5);
    EXPECT_NEAR(srgbEncode(0.001f), 0.01292f, 1e-6);
    EXPECT_NEAR(srgbDecode(0.5f), 0.214041f, 1e-5);
    EXPECT_NEAR(srgbDecode(128 / 255.f), 0.215861f, 1e-5);
}

TEST(Srgb, EveryCodeComesBack) {
    float last = -1;
    for (int k = -20; k <= 300; ++k) {
        const float stored = float(k) / 255, light = srgbDecode(stored);
        EXPECT_NEAR(srgbEncode(light), stored, 2e-6) << k;
        EXPECT_GT(light, last);
        last = light;
    }
}

} // namespace srgb_test

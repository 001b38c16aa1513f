#include "render/imaging.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace imaging_test {

using namespace alpenglow;
using namespace alpenglow::render;

TEST(Imaging, Exposure) {
    EXPECT_EQ(expose(0.3f, 1, 1), 0.3f);
    EXPECT_EQ(expose(0.25f, 4, 1), 1.0f);
    EXPECT_FLOAT_EQ(expose(0.125f, 2, 2), 0.5f); // (2/8)^(1/2)
    EXPECT_FLOAT_EQ(expose(-0.25f, 1, 2), -0.5f);
    EXPECT_EQ(expose(0, 1, 2.2f), 0.0f);
    EXPECT_EQ(expose(0.5f, 1, 0), 0.5f);
    EXPECT_EQ(expose(Color(0, 1, 4), 1, 2), Color(0, 1, 2));
}

TEST(Imaging, QuantiseRoundsAndClamps) {
    QuantizeRule q{0, 255, 0, 255, 0};
    EXPECT_EQ(quantize(0, q, 0, 0, 0, 0), 0);
    EXPECT_EQ(quantize(1, q, 0, 0, 0, 0), 255);
    EXPECT_EQ(quantize(2, q, 0, 0, 0, 0), 255);
    EXPECT_EQ(quantize(-1, q, 0, 0, 0, 0), 0);
    EXPECT_EQ(quantize(0.5, q, 0, 0, 0, 0), 128); // 127.5, ties to even
    EXPECT_EQ(quantize(std::nan(""), q, 0, 0, 0, 0), 0);
    EXPECT_EQ(quantize(std::numeric_limits<double>::infinity(), q, 0, 0, 0, 0), 255);
    QuantizeRule film{0, 0, 0, 0, 0.5};
    EXPECT_TRUE(film.floating());
    EXPECT_EQ(quantize(-3.7, film, 0, 0, 0, 0), -3.7);
    QuantizeRule shifted{16, 235, 16, 235, 0}; // 3Delight's four values
    EXPECT_EQ(quantize(0, shifted, 0, 0, 0, 0), 16);
    EXPECT_EQ(quantize(1, shifted, 0, 0, 0, 0), 235);
}

TEST(Imaging, DitherIsUniformAndFixed) {
    double sum = 0, square = 0, least = 1, most = -1;
    const int n = 400;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            double d = ditherValue(3, x, y, x % 3);
            EXPECT_EQ(d, ditherValue(3, x, y, x % 3));
            sum += d, square += d * d, least = std::min(least, d), most = std::max(most, d);
        }
    double count = double(n) * n;
    EXPECT_GE(least, -1);
    EXPECT_LT(most, 1);
    EXPECT_LE(std::fabs(sum / count), 4.753 * std::sqrt(1 / 3.0 / count));
    EXPECT_NEAR(square / count, 1 / 3.0, 4.753 * std::sqrt(4 / 45.0 / count));
    EXPECT_NE(ditherValue(3, 1, 2, 0), ditherValue(3, 1, 2, 1));
    EXPECT_NE(ditherValue(3, 1, 2, 0), ditherValue(3, 2, 1, 0));
}

TEST(Imaging, DitheredMeanKeepsTheValue) {
    // dither 0.5 makes the expectation of the rounded value the value itself: 100.3.
    QuantizeRule q{0, 255, 0, 255, 0.5};
    double sum = 0;
    const int n = 300;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) sum += quantize(100.3 / 255, q, 1, x, y, 0);
    EXPECT_NEAR(sum / n / n, 100.3, 4.753 * std::sqrt(0.3 * 0.7) / n);
}

TEST(Imaging, SampleClampKeepsTheHue) {
    EXPECT_EQ(clampSample(Color(1, 2, 3), 3), Color(1, 2, 3));
    EXPECT_EQ(clampSample(Color(2, 4, 6), 3), Color(1, 2, 3));
    EXPECT_EQ(clampSample(Color(20, 40, 60), 0), Color(20, 40, 60));
}

} // namespace imaging_test

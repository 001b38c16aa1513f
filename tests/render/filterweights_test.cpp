#include "render/filterweights.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace filterweights_test {

using namespace alpenglow::render;

namespace {

constexpr double kWidths[][2] = {{0.3, 0.3}, {1, 1}, {2, 2}, {2, 3.5}, {4, 4}, {5.3, 0.7}, {17, 9}};

/// The greatest value of a filter on a fine grid of its axes.
double greatest(const PixelFilter& f) {
    double most = 0;
    for (double t = -1; t <= 1; t += 1.0 / 512)
        most = std::max({most, std::fabs(f(t * f.xw / 2, 0)), std::fabs(f(0, t * f.yw / 2))});
    return most;
}

} // namespace

TEST(FilterWeights, AreWithinTheirErrorOfTheExactFilter) {
    std::mt19937 r(7);
    std::uniform_real_distribution<double> u(-0.55, 0.55); // a little beyond the support, too
    for (int k = 0; k < kFilterKinds; ++k)
        for (const auto& w : kWidths) {
            const PixelFilter f{FilterKind(k), w[0], w[1]};
            const FilterWeights weights(f);
            const double limit = FilterWeights::kError * greatest(f);
            for (int i = 0; i < 3000; ++i) {
                const double x = u(r) * f.xw, y = u(r) * f.yw;
                ASSERT_NEAR(weights(x, y), f(x, y), limit) << filterName(f.kind) << ' ' << w[0] << ' ' << w[1];
                if (weights.separable()) ASSERT_EQ(weights(x, y), weights.across(x) * weights.down(y));
            }
        }
}

TEST(FilterWeights, EndWhereTheFilterEnds) {
    for (int k = 0; k < kFilterKinds; ++k)
        for (double w : {0.7, 1.0, 2.0, 3.0, 4.0}) {
            const PixelFilter f{FilterKind(k), w, w};
            const FilterWeights weights(f);
            const double half = w / 2, beyond = std::nextafter(half, 9);
            for (double sign : {-1.0, 1.0}) {
                EXPECT_NEAR(weights(sign * half, 0), f(half, 0), 2e-6) << filterName(f.kind) << ' ' << w;
                EXPECT_NEAR(weights(0, sign * half), f(0, half), 2e-6) << filterName(f.kind) << ' ' << w;
                EXPECT_EQ(weights(sign * beyond, 0), 0) << filterName(f.kind) << ' ' << w;
                EXPECT_EQ(weights(0, sign * beyond), 0) << filterName(f.kind) << ' ' << w;
            }
            EXPECT_EQ(weights(std::numeric_limits<double>::quiet_NaN(), 0), 0);
        }
    const FilterWeights box(PixelFilter{FilterKind::Box, 1, 1}); // the edges belong to it
    EXPECT_EQ(box(-0.5, 0.5), 1);
}

} // namespace filterweights_test

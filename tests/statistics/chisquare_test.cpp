#include "chisquare.h"
#include <gtest/gtest.h>

namespace chisquare_test {

using namespace alpenglow::teststat;

// Q(1, x) = exp(-x); Q(1/2, x) = erfc(sqrt x): both branches of the evaluation.
TEST(ChiSquare, ClosedForms) {
    for (double x : {0.01, 0.5, 1.9, 2.1, 10.0, 30.0}) {
        EXPECT_NEAR(gammaQ(1, x) / std::exp(-x), 1, 1e-12) << x;
        EXPECT_NEAR(gammaQ(0.5, x) / std::erfc(std::sqrt(x)), 1, 1e-11) << x;
    }
}

TEST(ChiSquare, RejectsAWrongDensity) {
    std::vector<double> e(200, 500), good, bad;
    for (int i = 0; i < 200; ++i) {
        good.push_back(500 + (i % 2 ? 10 : -10));
        bad.push_back(500 * (i % 2 ? 1.08 : 0.92)); // +-8 %, statistic 200 * 3.2 = 640
    }
    EXPECT_GT(chiSquareP(good, e), 0.99);
    EXPECT_LT(chiSquareP(bad, e), kAlpha);
}

} // namespace chisquare_test

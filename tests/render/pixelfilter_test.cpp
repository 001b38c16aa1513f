#include "base/limits.h"
#include "render/pixelfilter.h"
#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace pixelfilter_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {
double at(FilterKind k, double xw, double yw, double x, double y) { return PixelFilter{k, xw, yw}(x, y); }
constexpr double kPiD = 3.14159265358979323846;
} // namespace

// Values worked out by hand from the formulas of RISpec 3.2, appendix E.
TEST(PixelFilter, SpotValues) {
    EXPECT_EQ(at(FilterKind::Box, 2, 1, 0.99, -0.5), 1);
    EXPECT_EQ(at(FilterKind::Box, 2, 1, 1.01, 0), 0);
    EXPECT_DOUBLE_EQ(at(FilterKind::Triangle, 4, 2, 1, 0.25), 0.5 * 0.75);
    EXPECT_DOUBLE_EQ(at(FilterKind::Gaussian, 2, 2, 1, 0), std::exp(-2.0));
    EXPECT_DOUBLE_EQ(at(FilterKind::Gaussian, 2, 4, 0.5, 1), std::exp(-1.0));
    // catmull-rom, r = 1/2: 3/8 - 5/4 + 2 = 9/8; r = 3/2: -27/8 + 45/4 - 12 + 4 = -1/8
    EXPECT_NEAR(at(FilterKind::CatmullRom, 4, 4, 0.3, 0.4), 1.125, 1e-14);
    EXPECT_NEAR(at(FilterKind::CatmullRom, 4, 4, 0.9, -1.2), -0.125, 1e-14);
    EXPECT_EQ(at(FilterKind::CatmullRom, 4, 4, 1.9, 1.9), 0);
    // separable: half of the above on each axis
    EXPECT_NEAR(at(FilterKind::SeparableCatmullRom, 4, 4, 0.5, -1.5), 0.5625 * -0.0625, 1e-14);
    // mitchell at 0: ((6 - 2/3)/6)^2 = (8/9)^2; at x = w/4 (t = 1): 1/18
    EXPECT_NEAR(at(FilterKind::Mitchell, 4, 4, 0, 0), 64.0 / 81, 1e-14);
    EXPECT_NEAR(at(FilterKind::Mitchell, 4, 2, 1, 0), 8.0 / 9 / 18, 1e-14);
    EXPECT_NEAR(at(FilterKind::Mitchell, 4, 4, 2, 0), 0, 1e-14);
    // cubic B-spline: 2/3 at 0, 1/6 at t = 1
    EXPECT_NEAR(at(FilterKind::BSpline, 4, 4, 0, 1), 2.0 / 3 / 6, 1e-14);
    // sinc at x = 1/2, w = 4: (2/pi) cos(pi/16)
    EXPECT_NEAR(at(FilterKind::Sinc, 4, 4, 0.5, 0), 2 / kPiD * std::cos(kPiD / 16), 1e-14);
    EXPECT_NEAR(at(FilterKind::Sinc, 4, 4, 1, 0), 0, 1e-15);
    EXPECT_EQ(at(FilterKind::Sinc, 4, 4, 0, 0), 1);
    EXPECT_EQ(at(FilterKind::Disk, 2, 4, 0.5, 1.7), 1); // 1/4 + 0.7225 < 1
    EXPECT_EQ(at(FilterKind::Disk, 2, 4, 0.6, 1.7), 0);
    // bessel at d = 1, w = 4: cos(pi/4) * 2 J1(pi), J1(pi) = 0.284615343179752... (A&S 9.1)
    EXPECT_NEAR(at(FilterKind::Bessel, 4, 4, 1, 0), std::cos(kPiD / 4) * 2 * 0.28461534317975, 1e-12);
    EXPECT_NEAR(at(FilterKind::Bessel, 4, 4, 0, 0), kPiD, 1e-15);
    EXPECT_NEAR(at(FilterKind::Bessel, 4, 4, 1e-5, 0), kPiD, 1e-8);
    EXPECT_EQ(at(FilterKind::Bessel, 4, 4, 1.5, 1.5), 0);
    // blackman-harris: the four coefficients add up to 1 at the centre and to 0.00006 at the edge
    EXPECT_NEAR(at(FilterKind::BlackmanHarris, 3, 3, 0, 0), 1, 1e-14);
    EXPECT_NEAR(at(FilterKind::BlackmanHarris, 3, 3, 1.5, 0), 0.00006, 1e-14);
    // lanczos at x = 1/2, w = 4: sinc(1/2) sinc(1/4)
    EXPECT_NEAR(at(FilterKind::Lanczos, 4, 4, 0.5, 0), (2 / kPiD) * (std::sin(kPiD / 4) / (kPiD / 4)), 1e-14);
    EXPECT_NEAR(at(FilterKind::Lanczos, 4, 4, 2, 0), 0, 1e-15);
}

TEST(PixelFilter, SymmetricAndZeroOutside) {
    for (int k = 0; k < kFilterKinds; ++k)
        for (double w : {1.0, 2.0, 5.0}) {
            PixelFilter f{FilterKind(k), w, w};
            for (double x = 0; x < 3; x += 0.173)
                for (double y = 0; y < 3; y += 0.211) {
                    EXPECT_EQ(f(x, y), f(-x, y));
                    EXPECT_EQ(f(x, y), f(x, -y));
                    EXPECT_NEAR(f(x, y), f(y, x), 1e-14) << filterName(f.kind);
                    if (x > w / 2 || y > w / 2) EXPECT_EQ(f(x, y), 0);
                    if (f.separable()) EXPECT_DOUBLE_EQ(f(x, y), f.axis(x, w) * f.axis(y, w));
                }
            EXPECT_EQ(f(std::numeric_limits<double>::quiet_NaN(), 0), 0);
        }
}

TEST(PixelFilter, Names) {
    for (int k = 0; k < kFilterKinds; ++k) EXPECT_EQ(filterByName(filterName(FilterKind(k))), FilterKind(k));
    EXPECT_FALSE(filterByName("gauss"));
}

TEST(PixelFilter, BadRequestsAreReported) {
    Diagnostics diag;
    SourcePlace place{"x.rib", 3, 5};
    PixelFilter f = makePixelFilter("gausian", 2, 3, place, diag);
    EXPECT_EQ(f.kind, FilterKind::Gaussian);
    EXPECT_EQ(f.yw, 3);
    ASSERT_EQ(diag.errors(), 1);
    EXPECT_EQ(diag.all()[0].place.line, 3);
    EXPECT_NE(diag.all()[0].hint.find("gaussian"), std::string::npos);
    f = makePixelFilter("box", -1, std::numeric_limits<double>::quiet_NaN(), place, diag);
    EXPECT_EQ(f.xw, 1);
    EXPECT_EQ(f.yw, 1);
    EXPECT_EQ(diag.errors(), 3);
    f = makePixelFilter("box", 1e9, 2, place, diag);
    EXPECT_EQ(f.xw, limits::kFilterWidth);
    EXPECT_EQ(diag.errors(), 4);
}

} // namespace pixelfilter_test

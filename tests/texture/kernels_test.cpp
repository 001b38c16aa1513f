// Filters that have a shape: lookups against sums of many points over the footprint, weighed as the pixel filters are (RISpec
// 3.2, appendix E, written out here anew), and what such filters do exactly.
#include "../nightly.h"
#include "pictures.h"
#include <cmath>
#include <limits>
#include <random>

namespace kernels_test {

using namespace alpenglow;
using namespace alpenglow::texture;
using namespace alpenglow::texture::test;
using display::Image;

namespace {

constexpr double kPi_ = 3.141592653589793;
constexpr Filter kShaped[] = {Filter::Disk,    Filter::CatmullRom, Filter::SeparableCatmullRom, Filter::Mitchell, Filter::Sinc,
                              Filter::Lanczos, Filter::Bessel};

double catmullRom(double r) {
    r = std::fabs(r);
    return r < 1 ? (3 * r * r * r - 5 * r * r + 2) / 2 : r < 2 ? (-r * r * r + 5 * r * r - 8 * r + 4) / 2 : 0;
}
double mitchell(double r) {
    r = std::fabs(r);
    return r < 1   ? (7 * r * r * r - 12 * r * r + 16. / 3) / 6
           : r < 2 ? (-7. / 3 * r * r * r + 12 * r * r - 20 * r + 32. / 3) / 6
                   : 0;
}
double sinc(double x) { return x == 0 ? 1 : std::sin(kPi_ * x) / (kPi_ * x); }
double bessel(double r) {
    constexpr double radius = 3.2383154841662362;
    if (r >= radius) return 0;
    return r == 0 ? kPi_ : std::cos(kPi_ / 2 * r / radius) * 2 * std::cyl_bessel_j(1, kPi_ * r) / r;
}

double weightOf(Filter f, double x, double y) {
    const double r = std::hypot(x, y);
    const bool inside = std::fabs(x) < 2 && std::fabs(y) < 2;
    switch (f) {
    case Filter::Disk:
        return r < .5 ? 1 : 0;
    case Filter::CatmullRom:
        return catmullRom(r);
    case Filter::SeparableCatmullRom:
        return catmullRom(x) * catmullRom(y);
    case Filter::Mitchell:
        return mitchell(x) * mitchell(y);
    case Filter::Sinc:
        return inside ? sinc(x) * std::cos(kPi_ * x / 8) * sinc(y) * std::cos(kPi_ * y / 8) : 0;
    case Filter::Lanczos:
        return inside ? sinc(x) * sinc(x / 2) * sinc(y) * sinc(y / 2) : 0;
    default:
        return bessel(r);
    }
}

/// Three waves across the map: about the width of a footprint, where filters differ most.
double wave(double s, double t) { return .5 + .25 * std::cos(2 * kPi_ * 3 * s + .4) + .25 * std::sin(2 * kPi_ * 3 * t + .9); }

Image waves(int n) {
    Image m = display::makeImage(n, n, {"y"});
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) m.pixel(x, y)[0] = float(wave((x + .5) / n, (y + .5) / n));
    return m;
}

/// The sum over the filter about (s, t) of a footprint with perpendicular sides a and b; whole waves, so the map goes on forever.
double overFilter(Filter f, double s, double t, const double a[2], const double b[2]) {
    constexpr int n = 120;
    const double reach = f == Filter::Disk ? .5 : f == Filter::Bessel ? 3.24 : 2;
    double sum = 0, weights = 0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double x = ((i + .5) * 2 / n - 1) * reach, y = ((j + .5) * 2 / n - 1) * reach, w = weightOf(f, x, y);
            sum += w * wave(s + x * a[0] + y * b[0], t + x * a[1] + y * b[1]);
            weights += w;
        }
    return sum / weights;
}

float look(Handle h, Filter f, double s, double t, const double a[2], const double b[2], float squeeze = 0) {
    LookupOptions o;
    o.filter = f;
    o.squeeze = squeeze;
    float v = -1;
    lookup2D(h, 0, 1, float(s), float(t), float(a[0]), float(a[1]), float(b[0]), float(b[1]), o, &v);
    return v;
}

} // namespace

TEST(Kernels, AreSumsOverTheFootprint) {
    const auto map = makeTextureFrom(withWrap(waves(128), "periodic"));
    for (const Filter f : kShaped) {
        std::mt19937 random(3);
        const auto number = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
        double worst = 0, boxes = 0;
        for (int k = 0; k < 25; ++k) {
            const double s = number(-1, 2), t = number(-1, 2), turn = number(0, 6.28), long_ = number(.03, .22),
                         short_ = long_ * number(.3, 1);
            const double a[2] = {long_ * std::cos(turn), long_ * std::sin(turn)},
                         b[2] = {-short_ * std::sin(turn), short_ * std::cos(turn)};
            const double want = overFilter(f, s, t, a, b);
            worst = std::max(worst, std::fabs(double(look(map.get(), f, s, t, a, b)) - want));
            boxes = std::max(boxes, std::fabs(double(look(map.get(), Filter::Box, s, t, a, b)) - want));
        }
        EXPECT_LT(worst, .02) << int(f);
        EXPECT_GT(boxes, .03) << int(f) << ": a box would do";
    }
}

TEST(Kernels, CatmullRomInterpolatesTexelsAndParabolas) {
    Image m = display::makeImage(32, 32, {"y"});
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) m.pixel(x, y)[0] = float((x + .5) * (x + .5) - 3 * (y + .5)) / 64;
    const auto map = makeTextureFrom(m);
    const double a[2] = {1. / 32, 0}, b[2] = {0, 1. / 32};
    for (const auto [x, y] : {std::pair{7.5, 9.5}, {12.1, 20.8}, {15.99, 4.3}, {20.25, 25.}})
        EXPECT_NEAR(look(map.get(), Filter::SeparableCatmullRom, x / 32, y / 32, a, b), (x * x - 3 * y) / 64, 2e-4) << x;
    // Smaller footprints do not sharpen further.
    const double c[2] = {.1 / 32, 0}, d[2] = {0, .1 / 32};
    EXPECT_NEAR(look(map.get(), Filter::SeparableCatmullRom, 12.1 / 32, 20.8 / 32, c, d), (12.1 * 12.1 - 3 * 20.8) / 64, 2e-4);
}

TEST(Kernels, KeepConstantsAndStayFinite) {
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    size_t turn = 0; // 3 divides none of the numbers of wraps, sizes and places: every two of all have their turn
    for (const char* wrap : {"clamp", "periodic", "mirror", "black"}) {
        const auto map = makeTextureFrom(withWrap(constant(50, 30, .25f), wrap));
        for (const Filter f : kShaped)
            for (const float size : {0.f, 1e-6f, .01f, .3f, 5.f, 1e20f, inf, nan})
                for (const float s : {.5f, -.2f, 1e9f, inf, nan}) {
                    if (!chosen(turn++, 3)) continue;
                    LookupOptions o;
                    o.filter = f;
                    float v[3] = {-1, -1, -1}, slopes[6], curves[9];
                    lookup2D(map.get(), 0, 3, s, .5f, size, 0, 0, size / 3, o, v, slopes, curves);
                    for (const float x : v) {
                        if (std::string(wrap) == "black") ASSERT_TRUE(std::isfinite(x)) << int(f) << " " << size << " " << s;
                        else ASSERT_NEAR(x, .25f, 1e-4f) << wrap << int(f) << " " << size << " " << s;
                    }
                    for (const float x : slopes) ASSERT_TRUE(std::isfinite(x));
                    for (const float x : curves) ASSERT_TRUE(std::isfinite(x));
                }
    }
}

TEST(Kernels, SlopesAreThoseOfTheLookup) {
    const auto map = makeTextureFrom(withWrap(waves(64), "periodic"));
    constexpr float texel = 1.f / 64;
    for (const Filter f : kShaped) {
        LookupOptions o;
        o.filter = f;
        float v, slopes[2], before, after; // slopes are differences over two texels
        lookup2D(map.get(), 0, 1, .31f, .37f, 2 * texel, 0, 0, texel, o, &v, slopes);
        lookup2D(map.get(), 0, 1, .31f - texel, .37f, 2 * texel, 0, 0, texel, o, &before);
        lookup2D(map.get(), 0, 1, .31f + texel, .37f, 2 * texel, 0, 0, texel, o, &after);
        EXPECT_NEAR(slopes[0], (after - before) / (2 * texel), 2e-3f) << int(f);
    }
}

TEST(Kernels, LongFootprintsAreWidened) {
    const auto map = makeTextureFrom(withWrap(waves(128), "periodic"));
    const double a[2] = {.2, 0}, thin[2] = {0, .002}, wide[2] = {0, .05};
    for (int k = 0; k < kFilters; ++k) {
        const auto f = Filter(k);
        EXPECT_NEAR(look(map.get(), f, .3, .4, a, thin, 1.f / 16), look(map.get(), f, .3, .4, a, wide), 1e-5f) << k;
        EXPECT_EQ(look(map.get(), f, .3, .4, a, wide, 1.f / 32), look(map.get(), f, .3, .4, a, wide)) << k;
    }
    EXPECT_GT(std::fabs(look(map.get(), Filter::Gaussian, .3, .4, a, thin) - look(map.get(), Filter::Gaussian, .3, .4, a, wide)),
              .01f);
}

} // namespace kernels_test

#include "render/pixelnet.h"
#include "render/rendering.h"
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace pixelnet_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

using Samples = std::vector<PixelNet::Numbers>;

Samples samplesOf(int nx, int ny, bool moves, bool lens, int x, int y) {
    const PixelNet net(nx, ny, moves, lens);
    const PixelNet::Pixel pixel = net.pixel(Sampler(5, x, y));
    Samples all;
    for (int k = 0; k < nx * ny; ++k) all.push_back(net.sample(pixel, k));
    return all;
}

/// Whether values fall into as many equal strata, one into each.
template <class F> bool oneInEach(int n, const F& value) {
    std::set<int> met;
    for (int k = 0; k < n; ++k) met.insert(int(value(k)));
    return int(met.size()) == n && *met.begin() == 0 && *met.rbegin() == n - 1;
}

/// A column of the array, by sample: its level of s. `Time` ... are columns; the cells' own, too.
int level(const Samples& all, int column, int s, int k) {
    const PixelNet::Numbers& n = all[size_t(k)];
    const float u = column == 2 ? n.time : column == 3 ? n.lens.x : n.lens.y;
    return column == 0 ? k % s : column == 1 ? k / s : int(double(u) * s);
}

} // namespace

TEST(PixelNet, EachNumberHasAllStrataAndEachPairAllLevels) {
    struct Case {
        int side;
        bool moves, lens;
        std::vector<int> columns; ///< of the array: 0, 1 places, 2 time, 3, 4 lens
    };
    const std::vector<Case> cases = {
        {2, true, false, {0, 1, 2}},       {3, true, false, {0, 1, 2}},      {3, false, true, {0, 1, 3, 4}},
        {4, true, true, {0, 1, 2, 3, 4}},  {5, true, true, {0, 1, 2, 3, 4}}, {6, true, false, {0, 1, 2}},
        {8, true, true, {0, 1, 2, 3, 4}},  {10, true, false, {0, 1, 2}},     {11, false, true, {0, 1, 3, 4}},
        {16, true, true, {0, 1, 2, 3, 4}}, {32, false, true, {0, 1, 3, 4}}};
    for (const Case& c : cases)
        for (int pixel = 0; pixel < 5; ++pixel) {
            const int s = c.side, n = s * s;
            const Samples all = samplesOf(s, s, c.moves, c.lens, pixel, 3 - pixel);
            for (size_t i = 0; i < c.columns.size(); ++i) {
                const int a = c.columns[i];
                if (a >= 2) EXPECT_TRUE(oneInEach(n, [&](int k) { return level(all, a, n, k); })) << s << ' ' << a;
                for (size_t j = i + 1; j < c.columns.size(); ++j) {
                    const int b = c.columns[j];
                    EXPECT_TRUE(oneInEach(n, [&](int k) { return level(all, a, s, k) * s + level(all, b, s, k); }))
                        << s << ' ' << a << ' ' << b;
                }
            }
        }
}

TEST(PixelNet, OtherNumbersOfSamplesAreStratifiedToo) {
    for (int pixel = 0; pixel < 5; ++pixel) {
        for (const auto& [nx, ny] : {std::pair{4, 2}, {1, 1}, {1, 7}, {5, 3}}) {
            const int n = nx * ny;
            const Samples all = samplesOf(nx, ny, true, false, pixel, 0);
            EXPECT_TRUE(oneInEach(n, [&](int k) { return double(all[size_t(k)].time) * n; })) << nx << ' ' << ny;
        }
        // The lens of 2 x 2 samples: every elementary interval of a (0,2,2)-net.
        const Samples all = samplesOf(2, 2, false, true, pixel, 0);
        for (const auto& [a, b] : {std::pair{4, 1}, {2, 2}, {1, 4}})
            EXPECT_TRUE(oneInEach(
                4, [&](int k) { return int(all[size_t(k)].lens.x * float(a)) * b + int(all[size_t(k)].lens.y * float(b)); }));
        EXPECT_EQ(all[0].time, 0);
    }
}

// Each number of each sample is even on [0, 1): means of 4,096 pixels, whose deviation is 1 / sqrt(12 * 4096).
TEST(PixelNet, EachSampleIsEven) {
    constexpr int kPixels = 4096;
    const PixelNet net(4, 4, true, true);
    double sum[16][3] = {}, square[16][3] = {};
    for (int i = 0; i < kPixels; ++i) {
        const PixelNet::Pixel pixel = net.pixel(Sampler(9, i % 64, i / 64));
        for (int k = 0; k < 16; ++k) {
            const PixelNet::Numbers n = net.sample(pixel, k);
            const double u[3] = {n.time, n.lens.x, n.lens.y};
            for (int d = 0; d < 3; ++d) {
                ASSERT_GE(u[d], 0);
                ASSERT_LT(u[d], 1);
                sum[k][d] += u[d];
                square[k][d] += u[d] * u[d];
            }
        }
    }
    // 96 means, family-wise 1e-3: 4.3 deviations; of u^2 the deviation is sqrt(4 / 45).
    for (int k = 0; k < 16; ++k)
        for (int d = 0; d < 3; ++d) {
            EXPECT_NEAR(sum[k][d] / kPixels, 0.5, 4.3 / std::sqrt(12.0 * kPixels)) << k << ' ' << d;
            EXPECT_NEAR(square[k][d] / kPixels, 1.0 / 3, 4.3 * std::sqrt(4 / 45.0 / kPixels)) << k << ' ' << d;
        }
}

namespace {

/// The root of the mean square error of pixels of n samples, each cut by an edge of its own of slope `angle` that moves by
/// `speed` pixels; `old`: the numbers of two scrambles that rays had before.
double errorOfMovingEdges(int side, double angle, double speed, bool old) {
    const double c = std::cos(angle), s = std::sin(angle);
    const PixelNet net(side, side, true, false);
    double sum = 0;
    constexpr int kPixels = 800, kSteps = 32;
    for (int i = 0; i < kPixels; ++i) {
        const Sampler sampler(3, i, 7);
        const PixelNet::Pixel pixel = net.pixel(sampler);
        const double edge = -speed + (speed + c + s) * (i + 0.5) / kPixels;
        double met = 0, exact = 0;
        for (int k = 0; k < side * side; ++k) {
            const Vec2 p = stratifiedOffset(3, i, 7, k, side, side, Jitter::Jittered);
            const double t = old ? sampler.get1(0, kUseTime, 0, uint32_t(k)) : net.sample(pixel, k).time;
            met += c * p.x + s * p.y < edge + speed * t;
        }
        for (int a = 0; a < kSteps * kSteps; ++a) { // over the pixel; over time in closed form
            const double at = (c * (a % kSteps + 0.5) + s * (a / kSteps + 0.5)) / kSteps;
            exact += 1 - std::clamp((at - edge) / speed, 0.0, 1.0);
        }
        const double off = met / (side * side) - exact / (kSteps * kSteps);
        sum += off * off;
    }
    return std::sqrt(sum / kPixels);
}

} // namespace

// An edge crosses at most 2 s - 1 of the s x s cells of place and time, and each of these is off by at most a half of a sample:
// the root of (2 s - 1) / 4 by s^2, of an edge along columns; of slopes two of three dimensions bound it no better than before.
TEST(PixelNet, MovingEdgesAreNotNoisierThanWithTwoScrambles) {
    for (int side : {2, 3, 4, 5, 8})
        for (double speed : {1.0, 3.0}) {
            const double straight = errorOfMovingEdges(side, 0, speed, false);
            EXPECT_LT(straight, 1.02 * errorOfMovingEdges(side, 0, speed, true)) << side << ' ' << speed;
            EXPECT_LT(straight, std::sqrt((2 * side - 1) / 4.0) / (side * side)) << side << ' ' << speed;
            if (side >= 3) { EXPECT_LT(straight, 0.9 * errorOfMovingEdges(side, 0, speed, true)) << side << ' ' << speed; }
            EXPECT_LT(errorOfMovingEdges(side, 0.6, speed, false), 1.08 * errorOfMovingEdges(side, 0.6, speed, true)) << side;
        }
}

} // namespace pixelnet_test

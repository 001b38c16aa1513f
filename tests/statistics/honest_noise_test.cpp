// T9 (docs/proof.md): the numbers a render reports about its noise are true. A thousand small renders of known pictures.
#include "render/filtersampler.h"
#include "render/noise.h"
#include "statistics/nightly.h"
#include <gtest/gtest.h>

namespace honest_noise_test {

using namespace alpenglow;
using namespace alpenglow::render;

namespace {

struct Integrand {
    double truth;
    double (*f)(Vec2 a, Vec2 b);
};

// Two pairs of numbers each, as a path uses several; truths in closed form.
const Integrand kPixels[] = {
    {1.0, [](Vec2 a, Vec2) { return 4.0 * a.x * a.y; }},
    {kPi / 4, [](Vec2 a, Vec2) { return a.x * a.x + a.y * a.y < 1 ? 1.0 : 0.0; }},
    {1.0, [](Vec2 a, Vec2 b) { return 16.0 * a.x * a.y * b.x * b.y; }},
    {(std::exp(1.0) - 1) * 0.5, [](Vec2 a, Vec2 b) { return std::exp(double(a.x)) * b.y; }},
    {0.5, [](Vec2 a, Vec2 b) { return a.x < b.x ? 1.0 : 0.0; }},
    {1.0 / 3, [](Vec2 a, Vec2 b) { return std::max(a.x, b.y) < 0.57735026919 ? 1.0 : 0.0; }},
    {2.0 / 3, [](Vec2 a, Vec2 b) { return double(std::max(a.y, b.x)); }},
    {2.0, [](Vec2 a, Vec2 b) { return 1 / std::sqrt(double(a.x) + 1e-30) * (a.x > 0) * (0.5 + b.y); }},
};
constexpr int kWidth = int(sizeof kPixels / sizeof kPixels[0]);
constexpr int kHeight = 4;

/// Column x shows integrand x in each of its pixels; with `only` >= 0 all columns show that one.
Film renderKnown(uint64_t seed, uint32_t spp, int only = -1) {
    FilmDescription d;
    d.width = only < 0 ? kWidth : kHeight;
    d.height = kHeight;
    d.window = {0, 0, d.width, kHeight};
    d.seed = seed;
    Film film(d);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < (only < 0 ? kWidth - 1 : kHeight);
             ++x) { // the last integrand has infinite variance: for the mean only
            Sampler s(seed, x, y);
            for (uint32_t i = 0; i < spp; ++i)
                film.add(x, y, i, {Color(float(kPixels[only < 0 ? x : only].f(s.get2(0, 0, 0, i), s.get2(1, 0, 0, i)))), 1, {}});
        }
    film.addRange({0, spp});
    return film;
}

} // namespace

// Of one pixel, with the variance of the 4 x 4 pixels about it, which show the same.
TEST(HonestNoise, NinetyFivePercentIntervalsCoverTheTruth) {
    for (uint32_t spp : {16u, 64u, 256u}) {
        int covered = 0, total = 0;
        double reported = 0, real = 0, moments = 0;
        const uint64_t seeds = spp < 256 || teststat::nightly() ? 1000 : 300; // of seven pictures
        for (int of = 0; of < kWidth - 1; ++of)
            for (uint64_t seed = 0; seed < seeds; ++seed) {
                Film f = renderKnown(seed * kWidth + uint64_t(of), spp, of);
                Interval i = confidenceInterval(pixelError(f, 1, 1, kHeight), 0.95);
                covered += std::fabs(i.mean - kPixels[of].truth) <= i.halfWidth;
                ++total;
                for (int x = 0; x < kHeight; ++x) {
                    ReplicaError e = replicaError(f, x, 1);
                    reported += e.se * e.se;
                    real += (e.mean - kPixels[of].truth) * (e.mean - kPixels[of].truth);
                    Moments m = f.moments(x, 1);
                    moments += m.variance / m.n;
                }
            }
        double share = double(covered) / total;
        EXPECT_GE(share, 0.935) << spp;
        EXPECT_LE(share, 0.965) << spp;
        EXPECT_NEAR(std::sqrt(reported / real), 1, 0.1) << spp;
        // Why replicas: the moment formula takes stratified samples for independent ones.
        EXPECT_GT(std::sqrt(moments / real), 1.1) << spp;
    }
}

// Of a window's mean, to which pixels with quite different errors add up. 5,000 renders: 1 % is three deviations of a share of 95
// %.
TEST(HonestNoise, IntervalsOfWindowsCoverTheTruth) {
    double truth = 0;
    for (int x = 0; x < kWidth - 1; ++x) truth += kPixels[x].truth / (kWidth - 1);
    for (uint32_t spp : {16u, 64u}) {
        int covered = 0;
        for (uint64_t seed = 0; seed < 5000; ++seed) {
            const Interval i = confidenceInterval(windowError(renderKnown(seed, spp), {0, 0, kWidth - 1, kHeight}), 0.95);
            covered += std::fabs(i.mean - truth) <= i.halfWidth;
        }
        EXPECT_GE(covered / 5000.0, 0.935) << spp;
        EXPECT_LE(covered / 5000.0, 0.965) << spp;
    }
}

// The estimate is unbiased at every sample count, also between powers of two; heavy tail included. Means over 4000 renders.
TEST(HonestNoise, UnbiasedAtOddSampleCounts) {
    for (uint32_t spp : {1u, 3u, 8u, 21u, 40u})
        for (int p = 0; p < kWidth - 1; ++p) {
            const int renders = 4000;
            double sum = 0, square = 0;
            for (int r = 0; r < renders; ++r) {
                Sampler s(uint64_t(r) + 10'000, p, 3);
                double mean = 0;
                for (uint32_t i = 0; i < spp; ++i) mean += kPixels[p].f(s.get2(0, 0, 0, i), s.get2(1, 0, 0, i)) / spp;
                sum += mean;
                square += mean * mean;
            }
            double mean = sum / renders, se = std::sqrt((square / renders - mean * mean) / (renders - 1));
            EXPECT_LE(std::fabs(mean - kPixels[p].truth), 4.753 * se + 1e-7) << "spp " << spp << " pixel " << p;
        }
}

// noiseQMC follows the real error down; the film's absolute figure is the image's RMSE.
TEST(HonestNoise, ImageErrorIsTheRmse) {
    double reported = 0, real = 0;
    for (uint64_t seed = 0; seed < 400; ++seed) {
        Film f = renderKnown(seed + 5000, 128);
        double e = noiseFigures(f).imageError, sum = 0;
        reported += e * e;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                double truth = x < kWidth - 1 ? kPixels[x].truth : 0, d = f.mean(x, y).y - truth;
                sum += d * d;
            }
        real += sum / kWidth / kHeight;
    }
    EXPECT_NEAR(std::sqrt(reported / real), 1, 0.1);
}

// A filter with negative lobes drawn by sign. The sign depends on one stratified number, so the count of negative weights in a
// replica is fixed to within one sample: its variance is at most 1/4, and that of the mean weight of n samples in R replicas at
// most R/4 (2 w / n)^2, w = A/T. Independent samples would have (w^2 - 1)/n, which falls only as 1/n.
TEST(HonestNoise, FilterSignsAreStrata) {
    FilterSampler filter({FilterKind::Mitchell, 4, 4});
    double weight = filter.absIntegral() / filter.integral();
    for (uint32_t n : {64u, 512u}) {
        double square = 0;
        const int renders = 500;
        for (int r = 0; r < renders; ++r) {
            Sampler s(1, r, 0);
            double sum = 0;
            for (uint32_t i = 0; i < n; ++i) sum += filter.sample(s.get2(0, 0, 0, i)).weight;
            square += (sum / n - 1) * (sum / n - 1);
        }
        double bound = kReplicas / 4.0 * (2 * weight / n) * (2 * weight / n), slack = 1 + 4.753 * std::sqrt(2.0 / renders);
        EXPECT_LE(square / renders, bound * slack) << n;
        if (n == 512) EXPECT_LT(square / renders, (weight * weight - 1) / n / 3);
    }
}

} // namespace honest_noise_test

// Adaptive sampling (docs/noise.md): which pixels get more samples has no bearing on what their mean is expected to be, and the
// errors that are reported stay true. Whole renders of known pictures, whose engine is a function of the sample's numbers.
#include "../render/plain_world.h"
#include "render/adaptive.h"
#include "render/noise.h"
#include "render/partfile.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include "statistics/chisquare.h"
#include "statistics/nightly.h"
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace adaptive_test {

using namespace alpenglow;
using namespace alpenglow::render;
using namespace alpenglow::teststat;

namespace {

constexpr int kWidth = 24, kHeight = 16;
constexpr double kSigmas = 4.753; // alpha 2e-6

/// Three bands, all of mean 1: nearly even; one sample in twenty brings all; a coin that takes two pairs of numbers.
float known(int x, Vec2 a, Vec2 b) {
    if (x < kWidth / 3) return 1 + .2f * (a.x - .5f);
    if (x < 2 * kWidth / 3) return a.x < .05f ? 20.f : 0.f;
    return a.x < b.x ? 2.f : 0.f;
}

struct KnownTracer final : Tracer {
    uint64_t seed = 0;
    integrator::Counters counts;
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out, const StopFlag*) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            const Sampler s(seed, rays[i].px, rays[i].py);
            out[i].color = Color(known(rays[i].px, s.get2(1, 7, 0, rays[i].sample), s.get2(2, 7, 0, rays[i].sample)));
            out[i].opacity = Color(1);
            out[i].z = 5;
            ++counts.camera;
        }
        return true;
    }
    const integrator::Counters& counters() const override { return counts; }
};

Engine knownEngine() {
    return render::test::plainEngine([](const world::World& w) {
        auto t = std::make_unique<KnownTracer>();
        t->seed = w.settings().seed;
        return t;
    });
}

/// What many renders of 64 samples a pixel on average show; the two tests below ask the same ones.
struct Many {
    int renders = 0, differ = 0, pixels = 0, windows = 0, of = 0;
    std::vector<double> sum = std::vector<double>(kWidth * kHeight), square = sum;
    double whole = 0, wholeSquare = 0, reported = 0, real = 0;

    void add(const Film& f) {
        ++renders;
        differ += f.samples().least < f.samples().most;
        double mean = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const double v = double(f.mean(x, y).y);
                sum[size_t(y * kWidth + x)] += v;
                square[size_t(y * kWidth + x)] += v * v;
                mean += v / (kWidth * kHeight);
                real += (v - 1) * (v - 1) / (kWidth * kHeight);
            }
        whole += mean;
        wholeSquare += mean * mean;
        for (const int x : {4, kWidth - 5}) { // in the middle of a band; of spikes, the mean of 64 is not near a normal one
            const Interval i = confidenceInterval(pixelError(f, x, kHeight / 2, 3));
            pixels += std::fabs(i.mean - 1) <= i.halfWidth;
            ++of;
        }
        const Interval w = confidenceInterval(windowError(f, f.window()));
        windows += std::fabs(w.mean - 1) <= w.halfWidth;
        const double e = noiseFigures(f).imageError;
        reported += e * e;
    }
};

struct Adaptive : testing::Test {
    std::filesystem::path dir;
    void SetUp() override {
        std::string name = (std::filesystem::temp_directory_path() / "alpenglow-adaptive-XXXXXX").string();
        dir = mkdtemp(name.data());
    }
    void TearDown() override { std::filesystem::remove_all(dir); }

    /// The film of a render under --noise.
    std::unique_ptr<Film> render(RenderSettings s) {
        Diagnostics d;
        Progress progress{ProgressMode::None};
        auto f = std::make_shared<scene::Frame>();
        f->options.xres = kWidth;
        f->options.yres = kHeight;
        f->options.hider = "path";
        f->options.filter = {"box", 1, 1};
        s.allowWrite = true;
        s.output = (dir / "a.exr").string();
        if (s.checkpoint.empty()) s.checkpoint = (dir / "a.part").string();
        s.restart = !s.resume;
        if (s.threads == 0) s.threads = 1;
        Renderer r(s, knownEngine(), d, progress, {});
        r.override(f->options);
        r.render(f);
        EXPECT_EQ(d.errors(), 0);
        return loadPart(s.checkpoint, d);
    }
    /// By so many samples a pixel on average: when it ends does not depend on what is drawn.
    std::unique_ptr<Film> render(uint64_t seed, uint32_t spp) {
        RenderSettings s;
        s.seed = seed;
        s.spp = spp;
        s.noise = 1e-9;
        return render(s);
    }
    const Many& many() {
        static Many all;
        for (const int renders = samples(200, 4800); all.renders < renders;) {
            auto f = render(seedBase() + uint64_t(all.renders) + 1, 64);
            if (!f || !f->spread()) throw std::runtime_error("a render without differing numbers of samples");
            all.add(*f);
        }
        return all;
    }
};

/// Samples 0 to 15 of pixels of noise `noise`, a fixed pattern by pixel.
Film pilot(int width, int height, float (*noise)(int x, int y), uint64_t seed = 1) {
    FilmDescription d;
    d.width = width;
    d.height = height;
    d.window = {0, 0, width, height};
    Film f(d);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (uint32_t i = 0; i < kPilotSamples; ++i)
                f.add(x, y, i, {Color(1 + noise(x, y) * (Sampler(seed, x, y).get2(0, 0, 0, i / 2 * 64 + i % 2).x - .5f)), 1, {}});
    f.addRange({0, kPilotSamples});
    return f;
}

} // namespace

// What a pixel's own samples say changes the rates of others, and its own by not a single unit.
TEST(Rates, APixelsOwnSamplesHaveNoSay) {
    const auto noise = [](int x, int y) { return .05f * float(1 + (x + 2 * y) % 5); };
    const Film f = pilot(30, 20, noise);
    const std::vector<uint16_t> before = ratesOf(f);
    for (const auto& [px, py] : {std::pair{0, 0}, {3, 4}, {15, 10}, {29, 19}}) {
        Film g = pilot(30, 20, noise);
        for (uint32_t i = 0; i < 8; i += 2) g.add(px, py, i, {Color(1000), 1, {}}); // one scramble sees what the other does not
        const std::vector<uint16_t> after = ratesOf(g);
        EXPECT_EQ(after[size_t(py * 30 + px)], before[size_t(py * 30 + px)]);
        EXPECT_NE(after, before);
    }
}

// r differs by 512: r^(2/3) by 64, which is the span from least to greatest; no noise at all gets the least; a picture without
// any noise, or too small to tell, the same everywhere.
TEST(Rates, FollowTheNoise) {
    const std::vector<uint16_t> rates = ratesOf(pilot(40, 40, [](int x, int) { return x < 20 ? .512f : .001f; }));
    EXPECT_EQ(rates[20 * 40 + 5], 512); // the mean of r^(2/3) is half of the noisy ones': rate 2, nearly
    EXPECT_EQ(rates[20 * 40 + 35], 32);
    const std::vector<uint16_t> none = ratesOf(pilot(40, 40, [](int, int) { return 0.f; }));
    EXPECT_EQ(std::count(none.begin(), none.end(), 256), 1600);
    const std::vector<uint16_t> half = ratesOf(pilot(40, 40, [](int x, int) { return x < 20 ? .5f : 0.f; }));
    EXPECT_EQ(half[20 * 40 + 5], 256);
    EXPECT_EQ(half[20 * 40 + 35], 32);
    const std::vector<uint16_t> tiny = ratesOf(pilot(3, 3, [](int, int) { return .5f; }));
    EXPECT_EQ(std::count(tiny.begin(), tiny.end(), 256), 9);
}

// Rates go with r^(2/3): r 8 times as large gives 4 times the samples.
TEST(Rates, PowerOfTwoThirds) {
    const std::vector<uint16_t> rates = ratesOf(pilot(80, 80, [](int x, int) { return x < 40 ? .8f : .1f; }));
    std::array<std::map<int, int>, 2> seen;
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 80; ++x)
            if (x < 36 || x > 43) ++seen[size_t(x > 40)][rates[size_t(y * 80 + x)]];
    const auto most = [](const std::map<int, int>& of) {
        return std::max_element(of.begin(), of.end(), [](auto& a, auto& b) { return a.second < b.second; })->first;
    };
    EXPECT_EQ(most(seen[0]), 4 * most(seen[1]));
}

TEST(Spread, CountsAndFiles) {
    Film f = pilot(24, 16, [](int x, int) { return x < 12 ? .5f : .01f; });
    EXPECT_FALSE(f.addSteps(1)) << "not spread yet";
    ASSERT_TRUE(f.spread(ratesOf(f)));
    EXPECT_FALSE(f.addRange({16, 17}));
    uint64_t sum = 0;
    for (const uint32_t steps : {4u, 4u, 8u, 16u}) {
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 24; ++x) {
                const SampleRange r = f.samplesOfSteps(x, y, steps);
                EXPECT_EQ(r.begin, f.count(x, y)); // no gap, nothing twice
                EXPECT_EQ(r.begin % kReplicas, 0u);
                for (uint32_t i = r.begin; i < r.end; ++i) f.add(x, y, i, {Color(1), 1, {}}), ++sum;
            }
        ASSERT_TRUE(f.addSteps(steps));
    }
    EXPECT_DOUBLE_EQ(f.samples().mean, 16 + double(sum) / (24 * 16));
    EXPECT_EQ(f.samples().least, 16u);
    EXPECT_GT(f.samples().most, 64u); // 2 + 64 of rate 1
    EXPECT_FALSE(f.addSteps(1u << 30));
    Film other = pilot(24, 16, [](int, int) { return 0.f; });
    Diagnostics d;
    EXPECT_FALSE(other.merge(f, d));
    EXPECT_FALSE(f.merge(other, d));
    EXPECT_NE(d.all()[0].message.find("different numbers of samples"), std::string::npos);
}

// T9: means of many renders whose pixels differ in their numbers of samples. By rates that come from the pixel alone the middle
// band would be at .76 (by a simulation apart from this program). What a forty-ninth part of its own noise would do is too little
// to be seen here: APixelsOwnSamplesHaveNoSay tests it.
TEST_F(Adaptive, EveryMeanIsUnbiased) {
    const Many& m = many();
    EXPECT_EQ(m.differ, m.renders);
    const double n = m.renders, mean = m.whole / n, se = std::sqrt((m.wholeSquare / n - mean * mean) / (n - 1));
    EXPECT_NEAR(mean, 1, kSigmas * se);
    EXPECT_LT(se, .003) << "finds 2 %";
    double chi = 0;
    for (size_t i = 0; i < m.sum.size(); ++i) {
        const double at = m.sum[i] / n, z = (at - 1) / std::sqrt((m.square[i] / n - at * at) / (n - 1));
        EXPECT_LT(std::fabs(z), kSigmas + 1) << i; // the largest of 384
        chi += z * z;
    }
    EXPECT_GT(gammaQ(kWidth * kHeight / 2., chi / 2), 2e-6) << chi;
}

// Intervals of pixels, their variance from what is about them, and of windows, where numbers of samples differ.
TEST_F(Adaptive, IntervalsCoverTheTruth) {
    const Many& m = many();
    // Of a share of .95 the deviation is .22 / sqrt(n): the band is widened by three of them beyond that of the plan.
    const auto slack = [](int n) { return std::max(0., 3 * .22 / std::sqrt(double(n)) - .015); };
    EXPECT_NEAR(double(m.pixels) / m.of, .95, .015 + slack(m.of));
    EXPECT_NEAR(double(m.windows) / m.renders, .95, .015 + slack(m.renders));
    EXPECT_NEAR(std::sqrt(m.reported / m.real), 1, .1);
}

// The same bits over threads, and when the render is broken off and taken up again anywhere.
TEST_F(Adaptive, SameBits) {
    const auto want = render(3, 60)->digest();
    for (const int threads : {2, 7}) {
        RenderSettings s;
        s.seed = 3;
        s.spp = 60;
        s.noise = 1e-9;
        s.threads = threads;
        EXPECT_EQ(render(s)->digest(), want) << threads;
    }
    for (const uint32_t at : {5u, 16u, 24u, 41u}) {
        std::filesystem::remove(dir / "c.part");
        RenderSettings s;
        s.seed = 3;
        s.noise = 1e-9;
        s.checkpoint = (dir / "c.part").string();
        s.spp = at;
        render(s);
        s.resume = true;
        s.spp = 60;
        EXPECT_EQ(render(s)->digest(), want) << at;
    }
}

// What is asked for is reached; parts, and whoever says so, have the same samples everywhere.
TEST_F(Adaptive, WhereItIsUsed) {
    RenderSettings s;
    s.noise = .1;
    const auto f = render(s);
    ASSERT_TRUE(f && f->spread());
    EXPECT_LE(noiseFigures(*f).noiseAtMost, .1);
    s.noise = 1e-9;
    s.samples = SampleRange{0, 40};
    const auto part = render(s);
    EXPECT_FALSE(part->spread());
    EXPECT_EQ(part->samplesPerPixel(), 40u);
}

} // namespace adaptive_test

// Pixel filters with negative parts under `path`: what does not vary stays as it is, and an edge is what the filter makes of it.
#include "base/sampler.h"
#include "display/imageio.h"
#include "plain_world.h"
#include "render/filtersampler.h"
#include "render/noise.h"
#include "render/partfile.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include <cmath>
#include <filesystem>
#include <functional>
#include <gtest/gtest.h>
#include <random>

namespace signedfilters_test {
using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

namespace {

FilmDescription describe(const FilterSampler& filter, int side = 1) {
    FilmDescription d;
    d.width = d.height = side;
    d.window = {0, 0, side, side};
    d.channels = {{"mean"}, {"near", ChannelRule::Min}, {"far", ChannelRule::Max}};
    d.negative = filter.negativePart();
    return d;
}

std::string name(const PixelFilter& f) { return std::string(filterName(f.kind)) + " " + std::to_string(f.xw); }

/// The film of samples 0 to n - 1 of every pixel; g is the light at an offset from the middle of the pixel.
Film filmOf(const FilterSampler& filter, uint32_t n, int side, const std::function<float(float x, float y)>& g, uint64_t seed = 1,
            uint32_t first = 0) {
    Film film(describe(filter, side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (uint32_t i = first; i < first + n; ++i) {
                const render::FilterSample s = filter.sample(Sampler(seed, x, y).get2(0, 0, 0, i));
                const float v = g(s.dx, s.dy), aovs[3] = {v, v, v};
                film.add(x, y, i, {Color(v), v, aovs, true, s.weight});
            }
    EXPECT_TRUE(film.addRange({first, first + n}));
    return film;
}

/// Integral of Mitchell and Netravali's cubic from -2 to t <= 0, by that of its halves; B = 0, C = 1/2 is Catmull and Rom's.
double cubicUpTo(double t, double B, double C) {
    const auto outer = [&](double u) { // antiderivative in u = |t|, 1 to 2
        return ((-B - 6 * C) * u * u * u * u / 4 + (6 * B + 30 * C) * u * u * u / 3 + (-12 * B - 48 * C) * u * u / 2 +
                (8 * B + 24 * C) * u) /
               6;
    };
    const auto inner = [&](double u) { // 0 to 1
        return ((12 - 9 * B - 6 * C) * u * u * u * u / 4 + (-18 + 12 * B + 6 * C) * u * u * u / 3 + (6 - 2 * B) * u) / 6;
    };
    const double u = -t;
    return u >= 1 ? outer(2) - outer(u) : outer(2) - outer(1) + inner(1) - inner(u);
}

/// What a filter of unit integral makes of an edge at t whose lit side is before it.
double edge(FilterKind k, double w, double t) {
    if (t > 0) return 1 - edge(k, w, -t);
    return k == FilterKind::Mitchell ? cubicUpTo(4 * t / w, 1.0 / 3, 1.0 / 3) : cubicUpTo(t, 0, 0.5);
}

/// Of pixels of n samples with an edge at t: mean and variance of what they show, and what they tell of the latter.
struct Spread {
    double mean = 0, variance = 0, estimated = 0;
};
Spread spreadOf(const PixelFilter& f, uint32_t n, int side, float t) {
    const Film film = filmOf(FilterSampler(f), n, side, [&](float x, float) { return x < t ? 1.0f : 0.0f; });
    Spread s;
    double squares = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double v = film.mean(x, y).x;
            s.mean += v / side / side;
            squares += v * v / side / side;
            const ReplicaError e = replicaError(film, x, y);
            EXPECT_NEAR(e.mean, v, 1e-5);
            s.estimated += e.se * e.se / side / side;
        }
    s.variance = squares - s.mean * s.mean;
    return s;
}

} // namespace

TEST(SignedFilters, AConstantStaysOneForEveryFilterAndWidth) {
    int apart = 0;
    for (int k = 0; k < kFilterKinds; ++k)
        for (const auto [xw, yw] : {std::pair{0.5, 0.5}, {4.0, 3.0}, {9.0, 7.0}}) {
            if (FilterKind(k) == FilterKind::Bessel && xw != 4) continue; // its table takes long
            const PixelFilter f{FilterKind(k), xw, yw};
            const FilterSampler filter(f);
            apart += filter.negativePart().has_value();
            for (uint32_t n : {1u, 2u, 5u, 16u}) {
                const Film film = filmOf(filter, n, 4, [](float, float) { return 0.3f; });
                for (int y = 0; y < 4; ++y)
                    for (int x = 0; x < 4; ++x) {
                        EXPECT_FLOAT_EQ(film.mean(x, y).x, 0.3f) << name(f) << " " << n;
                        EXPECT_FLOAT_EQ(film.alpha(x, y), 0.3f) << name(f) << " " << n;
                        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(film.aov(x, y, c), 0.3f) << name(f) << " " << n;
                        EXPECT_EQ(film.count(x, y), n);
                        EXPECT_NEAR(replicaError(film, x, y).se, 0, 1e-9) << name(f) << " " << n;
                        EXPECT_NEAR(replicaError(film, x, y).mean, 0.3, 1e-6) << name(f) << " " << n;
                        EXPECT_NEAR(film.moments(x, y).variance, 0, 1e-9) << name(f) << " " << n;
                        EXPECT_NEAR(surfaceError(film, x, y).mean, 0.3, 1e-6) << name(f) << " " << n;
                        EXPECT_NEAR(surfaceError(film, x, y).se, 0, 1e-9) << name(f) << " " << n;
                    }
            }
        }
    EXPECT_GE(apart, 10); // catmull-rom, separable-catmull-rom, sinc, bessel, mitchell, lanczos, where wide enough
}

// The mean of many pixels of 16 samples, which often have none of negative weight: a bias would stay.
TEST(SignedFilters, AnEdgeIsTheIntegralOfTheFilter) {
    for (const FilterKind k : {FilterKind::Mitchell, FilterKind::SeparableCatmullRom})
        for (const float t : {-1.6f, -0.9f, -0.3f, 0.0f, 0.7f, 1.5f}) {
            const Spread s = spreadOf({k, 4, 4}, 16, 40, t);
            EXPECT_NEAR(s.mean, edge(k, 4, double(t)), 4 * std::sqrt(s.variance / (40 * 40)) + 1e-5) << filterName(k) << " " << t;
        }
}

// The error that a pixel estimates for itself is the one that pixels have.
TEST(SignedFilters, NoiseIsThatOfPixels) {
    for (const FilterKind k : {FilterKind::Mitchell, FilterKind::SeparableCatmullRom})
        for (const float t : {-0.9f, 0.0f, 0.7f}) {
            const Spread s = spreadOf({k, 4, 4}, 128, 24, t);
            EXPECT_NEAR(s.estimated / s.variance, 1, 0.3) << filterName(k) << " " << t;
        }
}

TEST(SignedFilters, AnEdgeBetweenEvenSidesHasNoNoiseOfItsSurface) {
    const FilterSampler filter({FilterKind::Mitchell, 4, 4});
    Film film(describe(filter));
    for (uint32_t i = 0; i < 64; ++i) {
        const render::FilterSample s = filter.sample(Sampler(1, 0, 0).get2(0, 0, 0, i));
        const bool on = s.dx < 0.4f;
        film.add(0, 0, i, {Color(on ? 2.0f : 0.0f), 1, {}, on, s.weight});
    }
    EXPECT_NEAR(surfaceError(film, 0, 0).mean, 2, 1e-6);
    EXPECT_NEAR(surfaceError(film, 0, 0).se, 0, 1e-9);
    EXPECT_GT(replicaError(film, 0, 0).se, 0);
}

TEST(SignedFilters, PartsAndFilesKeepTheSums) {
    const FilterSampler filter({FilterKind::Lanczos, 5, 5});
    const auto g = [](float x, float y) { return x + 2 * y; };
    const Film whole = filmOf(filter, 24, 5, g);
    Film front = filmOf(filter, 7, 5, g), back = filmOf(filter, 17, 5, g, 1, 7);
    Diagnostics diags;
    ASSERT_TRUE(back.merge(front, diags));
    EXPECT_EQ(back.digest(), whole.digest());
    std::string folder = (fs::temp_directory_path() / "alpenglow-signed-XXXXXX").string();
    ASSERT_TRUE(mkdtemp(folder.data()));
    OutputPolicy policy;
    policy.root = folder;
    ASSERT_TRUE(savePart(whole, "a.part", policy, diags));
    const auto again = loadPart(folder + "/a.part", diags);
    fs::remove_all(folder);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->digest(), whole.digest());
    EXPECT_EQ(again->description(), whole.description());
    for (int x = 0; x < 5; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(again->aov(x, 2, c), whole.aov(x, 2, c));
    // Of another filter, with as many sums: no part of this.
    Film other = filmOf(FilterSampler({FilterKind::Mitchell, 4, 4}), 7, 5, g, 1, 24);
    EXPECT_FALSE(back.merge(other, diags));
    EXPECT_EQ(diags.errors(), 1);
}

namespace {

/// One colour everywhere.
struct EvenTracer final : Tracer {
    integrator::Counters counts;
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out,
               const StopFlag* stop) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            out[i].color = {0.7f, 0.3f, 11};
            out[i].opacity = Color(1.0f);
            out[i].z = 5;
            ++counts.camera;
        }
        return !*stop;
    }
    const integrator::Counters& counters() const override { return counts; }
};

} // namespace

TEST(SignedFilters, RendersOfAnEvenWorldAreEven) {
    for (const char* hider : {"path", "raytrace"})
        for (const char* filter : {"mitchell", "catmull-rom", "sinc", "lanczos"})
            for (const int threads : {1, 3}) {
                std::string folder = (fs::temp_directory_path() / "alpenglow-signed-XXXXXX").string();
                ASSERT_TRUE(mkdtemp(folder.data()));
                auto f = std::make_shared<scene::Frame>();
                f->options.xres = f->options.yres = 40;
                f->options.projection = "perspective";
                f->options.fov = 90;
                f->options.hider = hider;
                f->options.filter = {filter, 4, 4};
                RenderSettings s;
                s.output = folder + "/a.exr";
                s.spp = 4;
                s.threads = threads;
                Diagnostics diags;
                Progress progress{ProgressMode::None};
                Renderer renderer(s, test::plainEngine([](const world::World&) { return std::make_unique<EvenTracer>(); }), diags,
                                  progress, {});
                renderer.override(f->options);
                renderer.render(f);
                EXPECT_EQ(diags.errors(), 0);
                const auto picture = display::readImage(s.output, diags);
                fs::remove_all(folder);
                ASSERT_TRUE(picture);
                const float expected[4] = {0.7f, 0.3f, 11, 1};
                for (int y = 0; y < 40; ++y)
                    for (int x = 0; x < 40; ++x)
                        for (int c = 0; c < 4; ++c)
                            EXPECT_NEAR(picture->pixel(x, y)[c] / expected[c], 1, 1e-6) << hider << " " << filter;
            }
}

} // namespace signedfilters_test

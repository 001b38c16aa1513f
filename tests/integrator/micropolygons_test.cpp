// Where hidden shades with Settings::micropolygons: once for all samples that see a micropolygon, with edges of sqrt(ShadingRate)
// pixels, and what samples make of it.
#include "../sanitized.h"
#include "display/imageio.h"
#include "integrator/gridscene.h"
#include "integrator/limits.h"
#include "render/heap.h"
#include "render/renderer.h"
#include <algorithm>
#include <array>

namespace micropolygons_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Of a sample from the point whose colour it takes, in edges: two thirds where the diagonal cuts a micropolygon into triangles,
/// and steps are rounded by up to an eighth of an octave.
constexpr float kFarthest = 2 / 3.f * kRounding;

/// Ci is linear in P; the coordinates of the square are its red and green.
void writeShaders() {
    static const bool once = [] {
        writeShader("shows", "surface shows(uniform float o = 1) { Ci = o * color(xcomp(P), ycomp(P), zcomp(P)); Oi = o; }");
        writeShader("wavy",
                    "surface wavy() { Ci = color(.5 + .5 * sin(20 * xcomp(P)), .5 + .5 * sin(20 * ycomp(P)), u); Oi = 1; }");
        writeShader("glass",
                    "surface glass(uniform color o = .5; output varying color tint = 0) { Oi = o; tint = color(1, .5, .25);"
                    " Ci = o * Cs; }");
        writeShader("prints", "surface prints() { printf(\"at %f\\n\", xcomp(P)); Ci = Cs; Oi = 1; }");
        writeShader("pushes", "displacement pushes(float way = 0) { P += way * normalize(N); }");
        writeShader("noisy", "surface noisy() { Ci = random(); Oi = 1; }");
        return true;
    }();
    (void)once;
}
std::string picture(const std::string& inside, const std::string& options = "") {
    writeShaders();
    return gridPicture(inside, options);
}
/// The largest distance of a sample's red and green from where it lies.
float farthest(const std::vector<CameraRay>& rays, const std::vector<SampleResult>& results) {
    float most = 0;
    for (size_t i = 0; i < rays.size(); ++i)
        most =
            std::max({most, std::fabs(results[i].color.x - rays[i].origin.x), std::fabs(results[i].color.y - rays[i].origin.y)});
    return most;
}
bool same(const SampleResult& a, const SampleResult& b) {
    const auto of = [](const SampleResult& r) {
        return std::array{r.color.x, r.color.y, r.color.z, r.opacity.x, r.opacity.y, r.opacity.z, r.z, r.zSecond};
    };
    return of(a) == of(b) && a.aovs == b.aovs;
}

} // namespace

// 16 samples a pixel of a square that fills the picture: its steps are of 1/16, rounded to quarters of an octave, so that a pixel
// has .7 to 1.42 micropolygons, and along the diagonal both triangles have theirs.
TEST(Micropolygons, AreShadedOnceForAllSamples) {
    Scene s(picture("Surface \"shows\"\n" + kSquare), bySettings(true));
    Counters counters;
    const auto rays = samplesOf(4);
    const auto results = s.trace(rays, &counters);
    EXPECT_EQ(counters.camera, rays.size());
    EXPECT_GE(counters.points, size_t(kSide * kSide * .7));
    EXPECT_LE(counters.points, size_t(kSide * kSide * 1.42 + 4 * kSide));
    EXPECT_LE(farthest(rays, results), kFarthest * kPixel);
    for (size_t i = 0; i < rays.size(); ++i) EXPECT_EQ(results[i].z, 5);
}

// Edges have sqrt(ShadingRate) pixels: what a sample sees lies at most half of that away, but for the rounding of the steps.
TEST(Micropolygons, AreAsLargeAsShadingRateSays) {
    const auto rays = samplesOf(4);
    for (const float rate : {.0625f, .25f, 1.f, 4.f, 16.f, 1e4f}) {
        Scene s(picture("Surface \"shows\"\nShadingRate " + std::to_string(rate) + "\n" + kSquare), bySettings(true));
        const float error = farthest(rays, s.trace(rays)), edge = std::min(std::sqrt(rate) * kPixel, 2.f);
        EXPECT_LE(error, kFarthest * edge) << rate;
        if (rate >= .25f) EXPECT_GE(error, .3f * edge) << rate; // finer ones are as the samples lie
    }
}

// Rates that make no sense are bounded, not followed.
TEST(Micropolygons, BoundRatesThatMakeNoSense) {
    const auto rays = samplesOf(1);
    for (const char* rate : {"0", "-1", "1e-38", "1e38"}) {
        Scene s(picture(std::string("Surface \"shows\"\nShadingRate ") + rate + "\n" + kSquare +
                        "Translate .1 .1 0\nSphere .5 -.5 .5 360\n"),
                bySettings(true), 0);
        for (const SampleResult& r : s.trace(rays)) EXPECT_TRUE(std::isfinite(r.color.x)) << rate;
    }
}

// ShadingInterpolation "smooth" gives what is linear as it is, in the middle of micropolygons and across their borders.
TEST(Micropolygons, SmoothInterpolatesBetweenCorners) {
    const auto rays = samplesOf(3);
    for (const std::string& shape : {kSquare, std::string("Patch \"bilinear\" \"P\" [-1 -1 5  1 -1 5  -1 1 5  1 1 5]\n"),
                                     std::string("PointsPolygons [3 3] [0 1 2 0 2 3] \"P\" [-1 -1 5  -1 1 5  1 1 5  1 -1 5]\n")})
        for (const char* rate : {"1", "16", "100"}) {
            Scene s(
                picture("Surface \"shows\"\nShadingInterpolation \"smooth\"\nShadingRate " + std::string(rate) + "\n" + shape),
                bySettings(true));
            // Corners beyond the diagonal of a triangle that its steps do not meet are moved onto it.
            EXPECT_LE(farthest(rays, s.trace(rays)), .36f * kPixel * std::sqrt(std::stof(rate))) << shape << rate;
        }
}

// The same pictures as by samples, but for half a micropolygon, of every kind of shape. The shader's slope is at most 10 a unit;
// half of a micropolygon of a fifth of a pixel is 1/160 along either parameter, and rounded by up to 1.0906.
TEST(Micropolygons, ShowWhatSamplesShow) {
    constexpr float kFar = 10 * 2 / 160.f * 1.0906f;
    const auto rays = samplesOf(1);
    for (const std::string& shape : kShapes) {
        const std::string rib = picture("Surface \"wavy\"\nShadingRate .04\n" + shape);
        Scene fine(rib, bySettings(true)), exact(rib, bySettings(false));
        const auto a = fine.trace(rays), b = exact.trace(rays);
        int seen = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            EXPECT_EQ(a[i].opacity.x, b[i].opacity.x) << shape;
            EXPECT_NEAR(a[i].z, b[i].z, .05f * kPixel) << shape; // of the facet; by samples of the surface itself
            EXPECT_NEAR(a[i].color.x, b[i].color.x, kFar) << shape;
            EXPECT_NEAR(a[i].color.y, b[i].color.y, kFar) << shape;
            seen += b[i].opacity.x > 0;
        }
        EXPECT_GT(seen, 50) << shape;
    }
}

// Nothing depends on how rays are put together, in which order they come, or on what was shaded and forgotten before.
TEST(Micropolygons, BitsDependOnNothingElse) {
    const std::string rib = picture("Surface \"wavy\"\nTranslate 0 0 5\nSphere .9 -.9 .9 360\nSurface \"noisy\"\n" + kSquare);
    Scene s(rib, bySettings(true));
    const auto rays = samplesOf(2);
    const auto whole = s.trace(rays);
    Integrator one(s.world, s.diagnostics);
    std::vector<SampleResult> result(1);
    for (size_t i = rays.size(); i-- > 0;) {
        ASSERT_TRUE(one.trace({&rays[i], 1}, result, nullptr));
        ASSERT_TRUE(same(result[0], whole[i])) << i;
    }
}

// More than a thread keeps: what is shaded again is as before.
TEST(Micropolygons, WhatIsForgottenIsShadedAgain) {
    Scene s(picture("ShadingRate .01\nSurface \"glass\"\nPolygon \"P\" [-1 -1 3  -1 1 3  1 1 3  1 -1 3]\n"
                    "Surface \"wavy\"\n" +
                    kSquare),
            bySettings(true));
    const auto rays = samplesOf(8); // each has a micropolygon of its own, of 9 numbers, on the pane and behind it
    ASSERT_GT(2 * rays.size() * 9 * sizeof(float), limits::kMicropolygonBytes);
    Integrator i(s.world, s.diagnostics);
    std::vector<SampleResult> first(rays.size()), again(rays.size());
    ASSERT_TRUE(i.trace(rays, first, nullptr));
    const uint64_t once = i.counters().points;
    ASSERT_TRUE(i.trace(rays, again, nullptr));
    EXPECT_EQ(i.counters().points, 2 * once);
    for (size_t k = 0; k < rays.size(); ++k) ASSERT_TRUE(same(first[k], again[k]));
}

// Samples of one call go through panes, each of which has micropolygons of as many bytes as a thread keeps of all.
TEST(Micropolygons, LayersAreForgottenAsTheyAreLeft) {
    std::string panes = "ShadingRate .01\nSurface \"glass\" \"color o\" [.05 .05 .05]\n";
    for (int k = 0; k < 60; ++k) {
        const std::string z = std::to_string(3 + k);
        panes += "Polygon \"P\" [-1 -1 " + z + "  -1 1 " + z + "  1 1 " + z + "  1 -1 " + z + "]\n";
    }
    Scene s(picture(panes), bySettings(true));
    const auto rays = samplesOf(6);
    ASSERT_GT(rays.size() * 9 * sizeof(float), limits::kMicropolygonBytes);
    Integrator i(s.world, s.diagnostics);
    std::vector<SampleResult> results(rays.size());
    const uint64_t before = render::ownBytes();
    ASSERT_TRUE(i.trace(rays, results, nullptr));
    // A sanitizer keeps what is freed.
    if (!kSanitized) EXPECT_LT(render::ownBytes() - std::min(render::ownBytes(), before), 64 * limits::kMicropolygonBytes);
    EXPECT_NEAR(results[0].opacity.x, 1 - std::pow(.95f, 60.f), 1e-4);
}

// Four times as many large surfaces, beside each other, as tables are kept of; those that are made again are as before.
TEST(Micropolygons, TablesOfLargeSurfacesAreBounded) {
    constexpr size_t kTable = 24576; // bytes: 16 x 16 cells of 24 numbers
    const size_t n = 4 * limits::kPartialsBytes / kTable;
    std::string disks = "Surface \"constant\"\n";
    std::vector<CameraRay> rays;
    for (size_t i = 0; i < n; ++i) { // each of 64 pixels and more
        const std::string x = std::to_string(10 * i);
        disks += "TransformBegin\nTranslate " + x + " 0 50\nDisk 0 3 360\nTransformEnd\n";
        rays.push_back(rayTo({10 * float(i) + .5f, .5f, 0}, {10 * float(i) + .5f, .5f, 1}));
    }
    Scene s(picture(disks), bySettings(true));
    Integrator i(s.world, s.diagnostics);
    std::vector<SampleResult> first(n), again(n);
    const auto trace = [&](size_t from, size_t to, std::vector<SampleResult>& out) {
        for (size_t k = from; k < to; ++k) ASSERT_TRUE(i.trace({&rays[k], 1}, {&out[k], 1}, nullptr));
    };
    trace(0, n / 8, first); // what the first take besides
    const uint64_t before = render::ownBytes();
    trace(n / 8, n, first);
    if (!kSanitized) EXPECT_LT(render::ownBytes() - std::min(render::ownBytes(), before), 2 * limits::kPartialsBytes);
    trace(0, n, again);
    for (size_t k = 0; k < n; ++k) {
        ASSERT_LT(first[k].z, 51) << k;
        ASSERT_TRUE(same(first[k], again[k])) << k;
    }
}

// Opacity sample by sample: two panes before a wall, with a colour each; outputs are weighed as colours are.
TEST(Micropolygons, AreCompositedSampleBySample) {
    Settings settings = bySettings(true);
    settings.outputs = {"tint"};
    Scene s(picture("Surface \"glass\" \"color o\" [.5 .25 0]\nColor [1 1 1]\nPolygon \"P\" [-1 -1 3  -1 1 3  1 1 3  1 -1 3]\n"
                    "Surface \"glass\" \"color o\" [.5 .5 1]\nColor [0 1 1]\nPolygon \"P\" [-1 -1 4  -1 1 4  1 1 4  1 -1 4]\n"
                    "Surface \"constant\"\nColor [1 0 0]\n" +
                    kSquare),
            settings);
    for (const SampleResult& r : s.trace(samplesOf(1))) {
        EXPECT_NEAR(r.color.x, .5 + .5 * .5 * 0 + .25, 1e-6);
        EXPECT_NEAR(r.color.y, .25 + .75 * .5, 1e-6);
        EXPECT_NEAR(r.color.z, 0 + 1 * 1, 1e-6);
        EXPECT_NEAR(r.opacity.x, 1, 1e-6);
        ASSERT_EQ(r.aovs.size(), 3u);
        EXPECT_NEAR(r.aovs[0], 1 + .5, 1e-6);
        EXPECT_NEAR(r.aovs[1], .5 * (1 + .75), 1e-6);
        EXPECT_NEAR(r.aovs[2], .25 * (1 + 1), 1e-6);
        EXPECT_EQ(r.z, 3);
        EXPECT_EQ(r.zSecond, 4);
    }
}

// A displaced pane is gone through where rays meet it, not where it was: once, whichever way it went.
TEST(Micropolygons, DisplacedPanesAreGoneThroughOnce) {
    for (const char* way : {"-.7", ".7"}) {
        Scene s(picture("Displacement \"pushes\" \"float way\" [" + std::string(way) +
                        "]\nAttribute \"displacementbound\" "
                        "\"float sphere\" [1]\nSurface \"glass\"\n" +
                        kSquare),
                bySettings(true));
        for (const SampleResult& r : s.trace(samplesOf(1))) {
            EXPECT_EQ(r.opacity.x, .5f) << way;
            EXPECT_NEAR(std::fabs(r.z - 5), .7, 1e-4) << way;
        }
    }
}

// Matte surfaces hide what is behind and show nothing.
TEST(Micropolygons, MatteHidesAndShowsNothing) {
    Scene s(picture("Matte 1\nSurface \"constant\"\nPolygon \"P\" [-1 -1 3  -1 1 3  1 1 3  1 -1 3]\nMatte 0\n" + kSquare),
            bySettings(true));
    for (const SampleResult& r : s.trace(samplesOf(1))) {
        EXPECT_EQ(r.color, Color(0));
        EXPECT_EQ(r.opacity, Color(0));
    }
}

// Surfaces are shaded when the shutter opens, and move with their colours; samples of a lens see what the pinhole sees.
TEST(Micropolygons, MoveWithTheirColours) {
    Scene s("Shutter 0 1\n" +
                picture("Surface \"shows\"\nMotionBegin [0 1]\nTranslate 0 0 0\nTranslate .5 0 0\nMotionEnd\n" + kSquare),
            bySettings(true));
    auto rays = samplesOf(1);
    for (size_t i = 0; i < rays.size(); ++i) rays[i].time = rays[i].shutter = float(i % 7) / 6;
    const auto results = s.trace(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
        const float was = rays[i].origin.x - .5f * rays[i].shutter;
        if (was < -1 + kPixel) continue; // the square has left
        EXPECT_NEAR(results[i].color.x, was, kFarthest * kPixel);
        EXPECT_NEAR(results[i].color.y, rays[i].origin.y, kFarthest * kPixel);
    }
}

// Two threads that shade the same micropolygon print once; here one that forgets in between stands for them.
TEST(Micropolygons, PrintOnce) {
    Scene s(picture("Surface \"prints\"\nShadingRate 10000\n" + kSquare), bySettings(true));
    const auto rays = samplesOf(1);
    std::vector<SampleResult> results(rays.size());
    ::testing::internal::CaptureStdout();
    for (int k = 0; k < 2; ++k) {
        Integrator i(s.world, s.diagnostics);
        ASSERT_TRUE(i.trace(rays, results, nullptr));
    }
    s.world->flushPrints(true);
    const std::string text = ::testing::internal::GetCapturedStdout();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2) << text; // one a triangle
}

namespace {

struct Rendered {
    display::Image picture;
    uint64_t points = 0;
    int errors = 0;
};

/// A tracer that does not say what sees nothing.
class Blind final : public render::Tracer {
public:
    explicit Blind(std::unique_ptr<render::Tracer> t) : tracer_(std::move(t)) {}
    bool trace(std::span<const CameraRay> r, std::span<SampleResult> o, const StopFlag* s) override {
        return tracer_->trace(r, o, s);
    }
    const Counters& counters() const override { return tracer_->counters(); }

private:
    std::unique_ptr<render::Tracer> tracer_;
};

Rendered render(const std::string& options, const std::string& scene, bool blind = false, int threads = 1) {
    writeShaders();
    const std::string file = shaderFolder() + "/micropolygons.exr";
    Diagnostics diagnostics;
    render::RenderSettings s;
    s.threads = threads;
    s.allowWrite = true;
    s.shippedShaders = std::string(ALPENGLOW_SOURCE_DIR) + "/shaders";
    s.shaderPaths = {shaderFolder()};
    render::Progress progress(render::ProgressMode::None);
    render::Engine engine = render::transportEngine();
    if (blind)
        engine.tracer = [seeing = engine.tracer](std::shared_ptr<const World> w,
                                                 Diagnostics& d) -> std::unique_ptr<render::Tracer> {
            return std::make_unique<Blind>(seeing(std::move(w), d));
        };
    render::Renderer renderer(s, std::move(engine), diagnostics, progress);
    ri::RibReader reader(ri::ReaderOptions{}, renderer, diagnostics);
    reader.readMemory("Format 96 64 1\nPixelSamples 2 2\nProjection \"perspective\" \"fov\" 50\n" + options + "Display \"" +
                          file + "\" \"openexr\" \"rgbaz\"\nTranslate 0 0 4\nWorldBegin\n" + scene + "WorldEnd\n",
                      "micropolygons.rib");
    auto picture = display::readImage(file, diagnostics);
    EXPECT_TRUE(picture);
    std::filesystem::remove(file);
    return {picture ? *picture : display::Image(), renderer.stats().shading.points, diagnostics.errors()};
}
bool samePicture(const display::Image& a, const display::Image& b) {
    if (a.sampleCount() != b.sampleCount()) return false;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            for (int c = 0; c < 5; ++c)
                if (a.pixel(x, y)[c] != b.pixel(x, y)[c]) return false;
    return true;
}
const std::string kBalls = "Surface \"wavy\"\nAttributeBegin Translate -1 0 0 Sphere .4 -.4 .4 360 AttributeEnd\n"
                           "AttributeBegin Translate 1 .5 1 Torus .3 .1 0 360 360 AttributeEnd\n";

} // namespace

// What the scene says: by the hider, or by an option; what is no answer is an error.
TEST(Micropolygons, TheSceneChooses) {
    const std::string k16 = "PixelSamples 4 4\n";
    const Rendered grids = render(k16, kBalls),
                   samples = render(k16 + "Hider \"hidden\" \"string shading\" \"sample\"\n", kBalls);
    EXPECT_LT(2 * grids.points, samples.points);
    EXPECT_EQ(render(k16 + "Option \"hidden\" \"string shading\" \"sample\"\n", kBalls).points, samples.points);
    EXPECT_EQ(render(k16 + "Hider \"hidden\" \"string shading\" \"micropolygon\"\n", kBalls).points, grids.points);
    EXPECT_EQ(render(k16 + "Hider \"raytrace\"\n", kBalls).points, samples.points);
    EXPECT_EQ(grids.errors + samples.errors, 0);
    const Rendered wrong = render(k16 + "Hider \"hidden\" \"string shading\" \"grid\"\n", kBalls);
    EXPECT_EQ(wrong.errors, 1);
    EXPECT_TRUE(samePicture(wrong.picture, grids.picture));
}

// Tiles that see nothing are not sampled, and nobody can tell: not by a wide filter, nor with another number of threads.
TEST(Micropolygons, TilesThatSeeNothingCannotBeTold) {
    for (const char* filter : {"PixelFilter \"box\" 1 1\n", "PixelFilter \"sinc\" 9 7\n", "Projection \"orthographic\"\n"}) {
        const Rendered seen = render(filter, kBalls);
        EXPECT_TRUE(samePicture(render(filter, kBalls, true).picture, seen.picture)) << filter;
        EXPECT_TRUE(samePicture(render(filter, kBalls, false, 3).picture, seen.picture)) << filter;
    }
}

} // namespace micropolygons_test

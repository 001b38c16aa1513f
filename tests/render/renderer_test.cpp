// The renderer over a scene of closed forms in the engine's place: an emitter whose colour is the place on the image plane.
#include "fakeengine.h"
#include <cmath>
#include <gtest/gtest.h>

namespace renderer_test {

TEST(Renderer, HiddenReconstructsALinearFunctionExactly) {
    Folder dir;
    RenderSettings s;
    s.output = dir / "a.exr";
    Session run(s);
    auto f = frameOf("hidden");
    scene::Param jitter;
    jitter.name = "jitter";
    jitter.numbers = {0}; // a grid: its mean over the box is the value in the middle
    f->options.hiderParams = {jitter};
    run.frame(f);
    EXPECT_EQ(run.diags.errors(), 0);
    EXPECT_EQ(run.renderer.outcome().rendered, 1);
    display::Image i = read(s.output);
    ASSERT_EQ(i.width, 24);
    ASSERT_EQ(i.channels, (std::vector<std::string>{"r", "g", "b", "a"}));
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            EXPECT_NEAR(i.pixel(x, y)[0], planeX(x), 1e-6);
            EXPECT_NEAR(i.pixel(x, y)[1], planeY(y), 1e-6);
            EXPECT_EQ(i.pixel(x, y)[2], x < 12 ? 7 : 0);
            EXPECT_EQ(i.pixel(x, y)[3], 0.5f);
        }
}

// Blue is 7 left of the middle and 0 right of it, red and green change by an eighth a pixel: of 25 columns the middle one is cut
// in two. It and the one before differ by more than .3 from the other; sub-samples lie at thirds, fifths ... of a pixel, that in
// the middle on the right side.
TEST(Renderer, PixelsThatDifferAreRefined) {
    const auto number = [](const char* name, float value) {
        scene::Param p;
        p.name = name;
        p.numbers = {value};
        return p;
    };
    for (const int side : {3, 5, 7, 9})
        for (const int threads : {1, 3}) {
            Folder dir;
            RenderSettings s;
            s.output = dir / "a.exr";
            s.threads = threads;
            Session run(s);
            auto f = frameOf("raytrace", 25, 16);
            f->options.hiderParams = {number("aaSamples", float(side))};
            run.frame(f);
            EXPECT_EQ(run.diags.errors() + run.diags.warnings(), 0);
            const RenderStats::Classic& c = run.renderer.stats().classic;
            EXPECT_EQ(c.subsampledPixels, 2u * 16);
            EXPECT_EQ(c.subsampledRays, 2u * 16 * unsigned(side * side - 1));
            EXPECT_EQ(c.primary, 27u * 18); // a pixel more on all sides, to compare with
            display::Image i = read(s.output);
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 25; ++x) {
                    EXPECT_NEAR(i.pixel(x, y)[0], (x - 12) * .125, 1e-6) << x; // means of both grids are the value in the middle
                    EXPECT_NEAR(i.pixel(x, y)[1], (7.5 - y) * .125, 1e-6);
                    EXPECT_NEAR(i.pixel(x, y)[2], x < 12 ? 7 : x > 12 ? 0 : 7. * (side / 2) / side, 1e-6) << x;
                }
        }
    const struct {
        std::vector<scene::Param> params;
        const char* hider;
        unsigned pixels;
        bool said;
    } cases[] = {{{number("aaSamples", 3), number("aaThreshold", 2)}, "raytrace", 0, false},
                 {{number("aaThreshold", .3f)}, "raytrace", 2 * 16, false}, // 3 x 3
                 {{number("aaSamples", 1)}, "raytrace", 0, false},
                 {{number("aaSamples", 4)}, "raytrace", 2 * 16, true},
                 {{number("aaSamples", 1e9f)}, "raytrace", 2 * 16, true},
                 {{number("aaSamples", NAN)}, "raytrace", 0, true},
                 {{number("aaSamples", 3), number("aaThreshold", NAN)}, "raytrace", 2 * 16, true},
                 {{number("aaSamples", 3)}, "hidden", 0, true}};
    for (const auto& c : cases) {
        Folder dir;
        RenderSettings s;
        s.output = dir / "a.exr";
        Session run(s);
        auto f = frameOf(c.hider, 25, 16);
        f->options.hiderParams = c.params;
        run.frame(f);
        EXPECT_EQ(run.renderer.stats().classic.subsampledPixels, c.pixels);
        EXPECT_EQ(run.diags.errors() + run.diags.warnings() > 0, c.said);
    }
}

// What is infinitely far away is drawn as circles of confusion of the lens's diameter in the plane of focus. Blue is 7 to the
// left of an edge there: a pixel sees the part of the circle about it that lies to the left, by the area of a segment. A line
// cuts fewer than 192 of 64 by 64 cells of the lens, whose halves are counted wrong at random: 0.001 in the mean square.
TEST(Renderer, LensSamplesMakeCirclesOfConfusion) {
    const auto param = [](const char* name, std::vector<float> values) {
        scene::Param p;
        p.name = name;
        p.numbers = std::move(values);
        return p;
    };
    const double diameter = 4, focus = 3;
    for (const int threads : {1, 3}) {
        Folder dir;
        RenderSettings s;
        s.output = dir / "a.exr";
        s.threads = threads;
        s.spp = 2; // no say
        Session run(s);
        auto f = frameOf("raytrace");
        f->options.filter = {"gaussian", 3, 3};
        f->options.fstop = 2; // another lens, which has no say
        f->options.focalLength = 1;
        f->options.focalDistance = 7;
        f->options.hiderParams = {param("lensDiameter", {float(diameter)}), param("lensSamples", {64, 64}),
                                  param("focalDist", {float(focus)})};
        run.frame(f);
        EXPECT_EQ(run.diags.errors() + run.diags.warnings(), 0);
        EXPECT_EQ(run.renderer.stats().classic.primary, 24u * 16 * 64 * 64);
        display::Image i = read(s.output);
        double before = 7;
        for (int x = 0; x < 24; ++x) {
            const double t = std::clamp(planeX(x) * focus / (diameter / 2), -1.0, 1.0);
            const double part = (std::acos(t) - t * std::sqrt(1 - t * t)) / kPi;
            for (int y = 0; y < 16; ++y) {
                EXPECT_NEAR(i.pixel(x, y)[0], planeX(x), 1e-5);
                EXPECT_NEAR(i.pixel(x, y)[2] / 7, part, 0.005) << x;
                EXPECT_EQ(i.pixel(x, y)[2], i.pixel(x, 0)[2]); // the same places in all pixels
            }
            EXPECT_LE(i.pixel(x, 0)[2], before);
            before = i.pixel(x, 0)[2];
        }
    }
    const struct {
        std::vector<scene::Param> params;
        const char* hider;
        size_t rays;
        int errors, warnings;
    } cases[] = {
        {{param("lensSamples", {1, 1}), param("lensDiameter", {1}), param("focalDist", {2})}, "raytrace", 1, 0, 0}, // a pinhole
        {{param("lensSamples", {3})}, "raytrace", 9, 0, 0},
        {{param("lensSamples", {2.5f, 3})}, "raytrace", 4, 1, 0},
        {{param("lensSamples", {NAN, 3})}, "raytrace", 4, 1, 0},
        {{param("lensSamples", {1e9f, 3})}, "raytrace", 4, 1, 0},
        {{param("lensDiameter", {1})}, "raytrace", 4, 1, 0},
        {{param("lensDiameter", {-1}), param("focalDist", {2})}, "raytrace", 4, 1, 0},
        {{param("lensDiameter", {1}), param("focalDist", {0})}, "raytrace", 4, 2, 0},
        {{param("lensDiameter", {1}), param("focalDist", {3})}, "raytrace", 4, 0, 0},
        {{param("lensSamples", {3, 3}), param("aaSamples", {3})}, "raytrace", 9, 0, 1},
        {{param("lensSamples", {3, 3})}, "hidden", 4, 0, 1}};
    for (const auto& c : cases) {
        Folder dir;
        RenderSettings s;
        s.output = dir / "a.exr";
        Session run(s);
        auto f = frameOf(c.hider);
        f->options.hiderParams = c.params;
        run.frame(f);
        EXPECT_EQ(run.renderer.stats().classic.primary, c.rays * 24 * 16) << &c - cases;
        EXPECT_EQ(run.diags.errors(), c.errors) << &c - cases;
        EXPECT_EQ(run.diags.warnings(), c.warnings) << &c - cases;
    }
}

TEST(Renderer, PathHasTheSameMeansAndKnowsItsSamples) {
    Folder dir;
    RenderSettings s;
    s.output = dir / "a.exr";
    s.spp = 64;
    s.statsFile = dir / "s.json";
    Session run(s);
    run.frame(frameOf("path"));
    EXPECT_TRUE(run.renderer.writeStats());
    display::Image i = read(s.output);
    ASSERT_EQ(i.width, 24);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 24; ++x) {
            // Two replicas of 32 stratified points: each axis has at most 1/32 of a pixel (0.03) of error a replica, in the mean
            // far less.
            EXPECT_NEAR(i.pixel(x, y)[0], planeX(x), 0.01);
            EXPECT_NEAR(i.pixel(x, y)[1], planeY(y), 0.01);
            EXPECT_EQ(i.pixel(x, y)[2], x < 12 ? 7 : 0);
        }
    EXPECT_EQ(i.metadata["spp"], "64");
    EXPECT_EQ(run.renderer.stats().spp, 64u);
    EXPECT_EQ(run.renderer.stats().totalRays, 24u * 16 * 64);
    EXPECT_NE(bytesOf(dir / "s.json").find("\"noiseRSE999\""), std::string::npos);
}

TEST(Renderer, DefaultsOfSamples) {
    for (auto [hider, set, expected] :
         {std::tuple{"path", false, 64u}, {"path", true, 6u}, {"hidden", false, 4u}, {"raytrace", true, 6u}}) {
        Folder dir;
        RenderSettings s;
        s.output = dir / "a.exr";
        Session run(s);
        auto f = frameOf(hider, 4, 4);
        if (set) {
            f->options.pixelSamplesX = 3;
            f->options.pixelSamplesY = 2;
            f->options.pixelSamplesSet = true;
        }
        run.frame(f);
        EXPECT_EQ(run.renderer.stats().spp, expected) << hider;
    }
}

TEST(Renderer, ThreadsDoNotShow) {
    for (const char* hider : {"path", "hidden"}) {
        Folder dir;
        std::string first;
        for (int threads : {1, 2, 3}) {
            RenderSettings s;
            s.output = dir / "a.exr";
            s.threads = threads;
            Session run(s);
            auto f = frameOf(hider, 50, 37);
            f->options.filter = {"catmull-rom", 4, 4};
            run.frame(f);
            std::string b = bytesOf(s.output);
            ASSERT_FALSE(b.empty());
            if (threads == 1) first = b;
            else EXPECT_TRUE(b == first) << hider << " " << threads;
        }
    }
}

TEST(Renderer, AovsDepthAndExposure) {
    for (const char* hider : {"path", "hidden"}) {
        Folder dir;
        RenderSettings s;
        s.allowWrite = true;
        Session run(s);
        auto f = frameOf(hider);
        f->options.gain = 2;
        f->options.gamma = 2;
        f->options.displays = {{dir / "a.exr", "openexr", "rgbaz", {}, {}},
                               {"+" + (dir / "b.exr"), "openexr", "varying color tint,depthish,Oi", {}, {}}};
        scene::Param depthish;
        depthish.name = "depthish";
        f->options.displayChannels["depthish"] = depthish;
        run.frame(f);
        EXPECT_EQ(run.diags.errors(), 0);
        display::Image a = read(dir / "a.exr"), b = read(dir / "b.exr");
        ASSERT_GE(a.channel("z"), 0);
        EXPECT_EQ(a.pixel(3, 3)[a.channel("z")], 5);
        EXPECT_EQ(a.pixel(3, 3)[a.channel("a")], 0.5f);                    // no exposure
        EXPECT_NEAR(a.pixel(3, 3)[a.channel("b")], std::sqrt(14.f), 1e-5); // (2 * 7)^(1/2)
        ASSERT_GE(b.channel("tint.r"), 0) << hider;
        EXPECT_NEAR(b.pixel(20, 3)[b.channel("tint.r")], 2 * planeX(20), 0.06); // AOVs keep their units
        EXPECT_NEAR(b.pixel(20, 3)[b.channel("tint.b")], 1, 1e-6);
        EXPECT_NEAR(b.pixel(20, 3)[b.channel("depthish")], 5, 1e-5);
    }
}

TEST(Renderer, ImagerRunsAfterExposureOnTheRaster) {
    Folder dir;
    RenderSettings s;
    s.output = dir / "a.exr";
    s.crop = {0.5f, 1, 0, 1};
    Session run(s);
    auto f = frameOf("hidden");
    auto imager = std::make_shared<scene::ShaderCall>();
    imager->name = "fake";
    f->options.imager = imager;
    run.frame(f);
    display::Image i = read(s.output);
    ASSERT_EQ(i.width, 12);
    EXPECT_EQ(i.pixel(0, 0)[0], 12.5f); // pixel 12 of the whole picture
    EXPECT_EQ(i.pixel(0, 0)[3], 1);
}

TEST(Renderer, PixelPrintsASample) {
    RenderSettings s;
    s.pixel = {{0, 0}};
    s.spp = 32;
    std::vector<std::string> lines;
    Session run(s, [&](const std::string& l) { lines.push_back(l); });
    run.frame(frameOf("path"));
    ASSERT_EQ(lines.size(), 1u);
    float r, g, b, a;
    ASSERT_EQ(std::sscanf(lines[0].c_str(), "%f %f %f %f", &r, &g, &b, &a), 4);
    EXPECT_NEAR(r, planeX(0), 0.02);
    EXPECT_EQ(b, 7);
    EXPECT_EQ(a, 0.5f);
    EXPECT_FALSE(fs::exists("ri.pic"));
}

} // namespace renderer_test

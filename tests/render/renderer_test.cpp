// The renderer over a scene of closed forms in the engine's place: an emitter whose colour is the place on the image plane.
#include "display/imageio.h"
#include "plain_world.h"
#include "render/filmpicture.h"
#include "render/partfile.h"
#include "render/renderer.h"
#include "render/team.h"
#include "scene/scene.h"
#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace renderer_test {
using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

namespace {

struct FakeWorld final : test::PlainWorld {
    std::vector<int> outputWidths() const override {
        std::vector<int> w;
        for (const std::string& o : settings_.outputs) w.push_back(o == "depthish" ? 1 : 3);
        return w;
    }
    bool runImager(int n, const float* x, const float*, float* r, float*, float*, float* a, Diagnostics&,
                   const StopFlag*) const override {
        for (int i = 0; i < n; ++i) {
            r[i] = x[i]; // raster x, so that the test sees where it was run
            a[i] = 1;
        }
        return true;
    }
};

/// Red: x of the image plane, green: y, blue: 7 on the left half, else 0. Depth 5, covered by a half.
struct FakeTracer final : Tracer {
    integrator::Counters counts;
    std::vector<std::string> outputs;
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out,
               const StopFlag* stop) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            Vec3 p = rays[i].direction * (1 / rays[i].direction.z);
            out[i].color = {p.x, p.y, p.x < 0 ? 7.f : 0.f};
            out[i].opacity = Color(0.5f);
            out[i].z = 5, out[i].aovs.clear();
            for (const std::string& o : outputs) {
                if (o == "depthish") out[i].aovs.push_back(5);
                else out[i].aovs.insert(out[i].aovs.end(), {p.x * 2, 0, 1});
            }
            ++counts.camera;
        }
        return !*stop;
    }
    const integrator::Counters& counters() const override { return counts; }
};

Engine fakeEngine() {
    return test::plainEngine<FakeWorld>([](const world::World& w) {
        auto t = std::make_unique<FakeTracer>();
        t->outputs = w.settings().outputs;
        return t;
    });
}

struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "alpenglow-renderer-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const std::string& f) const { return (path / f).string(); }
};

std::shared_ptr<scene::Frame> frameOf(const char* hider, int w = 24, int h = 16) {
    auto f = std::make_shared<scene::Frame>();
    f->options.xres = w;
    f->options.yres = h;
    f->options.projection = "perspective";
    f->options.fov = 90;
    f->options.hider = hider;
    f->options.filter = {"box", 1, 1};
    return f;
}

struct Session {
    Diagnostics diags;
    Progress progress{ProgressMode::None};
    Renderer renderer;
    explicit Session(RenderSettings s, Renderer::Print print = {})
        : renderer(std::move(s), fakeEngine(), diags, progress, std::move(print)) {}
    void frame(const std::shared_ptr<scene::Frame>& f) {
        renderer.override(f->options);
        renderer.render(f);
    }
};

std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

display::Image read(const std::string& file) {
    Diagnostics d;
    auto i = display::readImage(file, d);
    EXPECT_TRUE(i) << file;
    return i ? *i : display::Image();
}

/// Place on the image plane of the middle of a pixel: 24 x 16, fov 90, so y spans -1..1 and x spans -1.5..1.5.
float planeX(int x) { return -1.5f + 3 * (float(x) + 0.5f) / 24; }
float planeY(int y) { return 1 - 2 * (float(y) + 0.5f) / 16; }

} // namespace

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

TEST(Renderer, MergedPartsAreTheWhole) {
    Folder dir;
    auto render = [&](const std::string& out, std::optional<SampleRange> r) {
        RenderSettings s;
        s.output = out;
        s.spp = 11;
        s.samples = r;
        Session run(s);
        auto f = frameOf("path");
        f->options.filter = {"mitchell", 4, 4};
        run.frame(f);
        EXPECT_EQ(run.diags.errors(), 0);
    };
    render(dir / "whole.exr", {});
    render(dir / "a.exr", SampleRange{0, 3});
    render(dir / "b.exr", SampleRange{3, 4});
    render(dir / "c.exr", SampleRange{4, 11});
    Diagnostics d;
    EXPECT_EQ(mergePictures({dir / "c.exr", dir / "a.exr", dir / "b.exr.part"}, dir / "m.exr", {}, d), MergeResult::Done);
    EXPECT_EQ(d.errors(), 0);
    EXPECT_TRUE(bytesOf(dir / "m.exr") == bytesOf(dir / "whole.exr"));
    EXPECT_EQ(mergePictures({dir / "a.exr", dir / "a.exr"}, dir / "n.exr", {}, d),
              MergeResult::NoInput); // the same samples twice
    EXPECT_FALSE(fs::exists(dir / "n.exr"));
    EXPECT_EQ(mergePictures({dir / "none.exr"}, dir / "n.exr", {}, d), MergeResult::NoInput);
}

TEST(Renderer, PartsOfDifferentScenesDoNotMerge) {
    Folder dir;
    for (int k = 0; k < 2; ++k) {
        RenderSettings s;
        s.output = dir / (k ? "b.exr" : "a.exr");
        s.samples = SampleRange{uint32_t(k), uint32_t(k) + 1};
        Session run(s);
        auto f = frameOf("path");
        if (k) f->options.fov = 80;
        run.frame(f);
    }
    Diagnostics d;
    EXPECT_EQ(mergePictures({dir / "a.exr", dir / "b.exr"}, dir / "m.exr", {}, d), MergeResult::NoInput);
    EXPECT_GT(d.errors(), 0);
}

TEST(Renderer, ResumeGivesTheBitsOfOneRender) {
    Folder dir;
    auto render = [&](const std::string& out, uint32_t spp, bool resume) {
        RenderSettings s;
        s.output = out;
        s.spp = spp;
        if (resume) s.checkpoint = dir / "c.part";
        s.resume = resume && fs::exists(s.checkpoint);
        Session run(s);
        run.frame(frameOf("path"));
        EXPECT_EQ(run.diags.errors(), 0);
    };
    render(dir / "whole.exr", 20, false);
    render(dir / "x.exr", 5, true);
    render(dir / "y.exr", 20, true);
    EXPECT_TRUE(bytesOf(dir / "y.exr") == bytesOf(dir / "whole.exr"));
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

TEST(Renderer, StopBeforeAPassWritesNothing) {
    Folder dir;
    StopFlag stop{1};
    RenderSettings s;
    s.output = dir / "a.exr";
    s.stop = &stop;
    Session run(s);
    run.frame(frameOf("path"));
    EXPECT_TRUE(run.renderer.outcome().interrupted);
    EXPECT_EQ(run.renderer.outcome().rendered, 0);
    EXPECT_FALSE(fs::exists(s.output));
}

TEST(Renderer, NamesOfSeveralFrames) {
    Folder dir;
    RenderSettings s;
    s.output = dir / "a.exr";
    Session run(s);
    for (int k : {1, 2}) {
        auto f = frameOf("hidden", 4, 4);
        f->options.frameNumber = k;
        run.frame(f);
    }
    EXPECT_FALSE(fs::exists(dir / "a.exr"));
    EXPECT_TRUE(fs::exists(dir / "a.0001.exr"));
    EXPECT_TRUE(fs::exists(dir / "a.0002.exr"));
    // Worlds outside of frames: the first has the name itself.
    s.output = dir / "b.exr";
    Session worlds(s);
    for (int k = 0; k < 2; ++k) worlds.frame(frameOf("hidden", 4, 4));
    EXPECT_TRUE(fs::exists(dir / "b.exr"));
    EXPECT_TRUE(fs::exists(dir / "b.0002.exr"));
    EXPECT_EQ(worlds.diags.all().size(), 0u);
}

// Published scenes show in a window what they write: Display "a.tif" "file" "rgba", Display "+a.tif" "framebuffer" "rgb".
TEST(Renderer, OneDisplayForEachFile) {
    for (int order : {0, 1, 2}) {
        Folder dir;
        RenderSettings s;
        s.allowWrite = true;
        Session run(s);
        auto f = frameOf("hidden", 4, 4);
        const std::string a = dir / "a.tif";
        const scene::Display file{a, "file", "rgba", {}, {}}, window{a, "framebuffer", "rgb", {}, {}},
            more{a, "tiff", "z", {}, {}};
        using Displays = std::vector<scene::Display>;
        f->options.displays = order == 0   ? Displays{file, window}
                              : order == 1 ? Displays{window, file}
                                           : Displays{file, more, {dir / "b.tif", "tiff", "z", {}, {}}};
        run.frame(f);
        EXPECT_EQ(read(dir / "a.tif").channels.size(), 4u) << order;
        EXPECT_EQ(run.diags.warnings(), order == 2) << order;
        EXPECT_EQ(fs::exists(dir / "b.tif"), order == 2);
        // Two files of one name: neither is lost.
        EXPECT_EQ(fs::exists(dir / "a.2.tif"), order == 2);
        if (order == 2) EXPECT_EQ(read(dir / "a.2.tif").channels, std::vector<std::string>{"z"});
    }
}

// A shadow pass and a picture, as old scenes have them: what the command line says about pictures leaves the map as it is.
TEST(Renderer, OptionsAboutPicturesLeaveMapsAlone) {
    for (const char* hider : {"hidden", "path"}) {
        Folder dir;
        RenderSettings s;
        s.allowWrite = true;
        s.output = dir / "picture.exr";
        s.width = 12;
        s.height = 9;
        s.gamma = 2;
        s.hider = "path";
        s.spp = 4;
        Session run(s);
        auto pass = frameOf(hider, 24, 16), picture = frameOf("hidden", 24, 16);
        pass->options.displays = {{dir / "light.z", "zfile", "z", {}, {}}};
        picture->options.displays = {{dir / "scene.tif", "file", "rgba", {}, {}}, {dir / "depth.exr", "openexr", "z", {}, {}}};
        run.frame(pass);
        EXPECT_EQ(run.renderer.stats().spp, 4u) << "PixelSamples 2 2 of the scene";
        run.frame(picture);
        run.renderer.finish();
        EXPECT_EQ(run.diags.all().size(), 0u);
        const display::Image map = read(dir / "light.z");
        EXPECT_EQ(map.width, 24);
        EXPECT_EQ(pass->options.hider, "hidden");
        EXPECT_EQ(map.channels, std::vector<std::string>{"z"});
        EXPECT_NEAR(map.pixel(3, 3)[0], 5, 1e-5);
        EXPECT_EQ(read(dir / "picture.exr").width, 12);
        EXPECT_EQ(picture->options.hider, "path");
        EXPECT_EQ(read(dir / "depth.exr").width, 12) << "depth of the same camera";
        EXPECT_FALSE(fs::exists(dir / "scene.tif"));
    }
}

TEST(Renderer, ASceneOfMapsAloneSaysThatOptionsHaveNoEffect) {
    Folder dir;
    RenderSettings s;
    s.allowWrite = true;
    s.output = dir / "a.png";
    s.hider = "path";
    Session run(s);
    auto f = frameOf("hidden", 4, 4);
    f->options.displays = {{dir / "light.z", "shadow", "z", {}, {}}};
    run.frame(f);
    run.renderer.finish();
    EXPECT_TRUE(fs::exists(dir / "light.z"));
    EXPECT_FALSE(fs::exists(dir / "a.png"));
    ASSERT_EQ(run.diags.all().size(), 1u);
    EXPECT_EQ(run.diags.all()[0].message.rfind("-o, --hider: without effect", 0), 0u) << run.diags.all()[0].message;
}

TEST(Renderer, FramesNeverWriteEachOthersPictures) {
    const auto frame = [](int number, const std::string& name, const char* type, const char* mode) {
        auto f = frameOf("hidden", 4, 4);
        f->options.inFrame = true;
        f->options.frameNumber = number;
        f->options.displays = {{name, type, mode, {}, {}}};
        return f;
    };
    Folder dir;
    RenderSettings s;
    s.allowWrite = true;
    {
        Session run(s);
        for (int k : {1, 2, 3}) run.frame(frame(k, dir / "a.exr", "openexr", "rgba"));
        EXPECT_EQ(run.diags.warnings(), 2);
    }
    for (const char* name : {"a.exr", "a.0002.exr", "a.0003.exr"}) EXPECT_TRUE(fs::exists(dir / name)) << name;
    // The names do not depend on which frames are wanted.
    fs::remove_all(dir.path);
    fs::create_directory(dir.path);
    {
        Session run(s);
        for (int k : {1, 2}) run.renderer.passOver(frame(k, dir / "a.exr", "openexr", "rgba")->options);
        run.frame(frame(3, dir / "a.exr", "openexr", "rgba"));
    }
    EXPECT_TRUE(fs::exists(dir / "a.0003.exr"));
    EXPECT_FALSE(fs::exists(dir / "a.exr"));
    // What a Make request reads, and maps, are made anew for each frame under the same name.
    Session run(s);
    for (int k : {1, 2}) {
        run.frame(frame(k, dir / "seen.exr", "openexr", "rgba"));
        run.renderer.passOverTexture({dir / "seen.exr", dir / "seen.tx"});
        run.frame(frame(k, dir / "light.z", "zfile", "z"));
        run.frame(frame(k, dir / "picture.####.exr", "openexr", "rgba"));
    }
    EXPECT_EQ(run.diags.all().size(), 0u);
    for (const char* name : {"seen.exr", "light.z", "picture.0001.exr", "picture.0002.exr"})
        EXPECT_TRUE(fs::exists(dir / name)) << name;
    EXPECT_FALSE(fs::exists(dir / "seen.0002.exr") || fs::exists(dir / "light.0002.z"));
}

TEST(Renderer, PartsOfTheSamplesAreTheWhole) {
    Folder dir;
    const auto render = [&](const std::string& name, std::optional<std::array<uint32_t, 2>> part) {
        RenderSettings s;
        s.output = dir / name;
        s.spp = 11;
        s.part = part;
        Session run(s);
        run.frame(frameOf("path"));
        return run.diags.errors();
    };
    EXPECT_EQ(render("whole.exr", {}), 0);
    std::vector<std::string> parts;
    for (uint32_t k = 1; k <= 4; ++k) {
        parts.push_back(dir / ("p" + std::to_string(k) + ".exr"));
        EXPECT_EQ(render("p" + std::to_string(k) + ".exr", std::array{k, 4u}), 0);
    }
    Diagnostics d;
    EXPECT_EQ(mergePictures(parts, dir / "all.exr", {}, d), MergeResult::Done);
    EXPECT_TRUE(d.all().empty());
    EXPECT_TRUE(bytesOf(dir / "all.exr") == bytesOf(dir / "whole.exr"));
    EXPECT_EQ(render("e.exr", std::array{1u, 12u}), 1) << "an empty part";
    EXPECT_FALSE(fs::exists(dir / "e.exr"));
    // A part that is missing: at the end too, because parts know the whole. Later it is added.
    EXPECT_EQ(mergePictures({parts[0], parts[1], parts[2]}, dir / "three.exr", {}, d), MergeResult::Done);
    ASSERT_EQ(d.all().size(), 1u);
    EXPECT_EQ(d.warnings(), 1);
    EXPECT_NE(d.all()[0].message.find("8:11 of 0:11"), std::string::npos) << d.all()[0].message;
    Diagnostics late;
    EXPECT_EQ(mergePictures({dir / "three.exr", parts[3]}, dir / "late.exr", {}, late), MergeResult::Done);
    EXPECT_TRUE(late.all().empty());
    EXPECT_TRUE(bytesOf(dir / "late.exr") == bytesOf(dir / "whole.exr"));
}

TEST(Renderer, MissingSamples) {
    using Ranges = std::vector<SampleRange>;
    EXPECT_EQ(missingSamples({{0, 8}}, {0, 8}), Ranges{});
    EXPECT_EQ(missingSamples({{0, 8}, {12, 16}}, {0, 16}), (Ranges{{8, 12}}));
    EXPECT_EQ(missingSamples({{2, 4}, {6, 8}}, {0, 10}), (Ranges{{0, 2}, {4, 6}, {8, 10}}));
    EXPECT_EQ(missingSamples({{2, 20}}, {4, 8}), Ranges{});
    EXPECT_EQ(missingSamples({{20, 30}}, {4, 8}), (Ranges{{4, 8}}));
    EXPECT_EQ(rangeFromText("3:64"), (SampleRange{3, 64}));
    for (const char* bad : {"", "3", "3:", "4:4", "5:4", "0:8x", "-1:4", "0:99999999999"})
        EXPECT_FALSE(rangeFromText(bad)) << bad;
}

TEST(Renderer, ACheckpointIsNotReplacedUnasked) {
    Folder dir;
    const auto render = [&](uint32_t spp, bool resume, bool restart) {
        RenderSettings s;
        s.output = dir / "a.exr";
        s.checkpoint = dir / "c.part";
        s.spp = spp;
        s.resume = resume;
        s.restart = restart;
        Session run(s);
        run.frame(frameOf("path"));
        return run.diags.errors();
    };
    EXPECT_EQ(render(4, false, false), 0);
    const std::string first = bytesOf(dir / "c.part");
    EXPECT_EQ(render(2, false, false), 1);
    EXPECT_TRUE(bytesOf(dir / "c.part") == first);
    EXPECT_EQ(render(6, true, false), 0);
    EXPECT_EQ(render(2, false, true), 0);
    Diagnostics d;
    auto film = loadPart(dir / "c.part", d);
    ASSERT_TRUE(film);
    EXPECT_EQ(film->samplesPerPixel(), 2u);
}

TEST(Team, EveryTaskOnceAndExceptionsArrive) {
    Team team(3);
    std::vector<std::atomic<int>> done(1000);
    StopFlag halt{0};
    EXPECT_TRUE(team.run(done.size(), &halt, [&](int w, size_t i) { done[i] += w < 3 ? 1 : 100; }, [](size_t) {}));
    for (auto& d : done) EXPECT_EQ(d, 1);
    EXPECT_THROW(team.run(
                     10, &halt,
                     [&](int, size_t i) {
                         if (i == 5) throw std::bad_alloc();
                     },
                     [](size_t) {}),
                 std::bad_alloc);
    EXPECT_EQ(halt, 1);
    halt = 0;
    const auto wait = [](int, size_t) { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
    EXPECT_THROW(team.run(1000, &halt, wait, [](size_t) { throw std::bad_alloc(); }), std::bad_alloc); // of who looks on, too
    EXPECT_EQ(halt, 1);
}

} // namespace renderer_test

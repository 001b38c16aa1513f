// Image samples over a scene of closed forms: the plane z = 4 + x of the image plane.
#include "display/imageio.h"
#include "plain_world.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

namespace imageloop_test {
using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

namespace {

struct Slope final : Tracer {
    transport::Counters counts;
    bool trace(std::span<const transport::CameraRay> rays, std::span<transport::SampleResult> out,
               const StopFlag* stop) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            const Vec3 p = rays[i].direction * (1 / rays[i].direction.z);
            out[i].color = {p.x, p.y, 1};
            out[i].opacity = Color(1.f);
            out[i].z = 4 + p.x;
            ++counts.camera;
        }
        return !*stop;
    }
    const transport::Counters& counters() const override { return counts; }
};

/// Leaves memory behind in the first result of a call, and counts the calls that find none.
struct Keeper final : Tracer {
    int& fresh;
    transport::Counters counts;
    explicit Keeper(int& f) : fresh(f) {}
    bool trace(std::span<const transport::CameraRay>, std::span<transport::SampleResult> out, const StopFlag*) override {
        fresh += out[0].aovs.capacity() < 100;
        out[0].aovs.reserve(100);
        return true;
    }
    const transport::Counters& counters() const override { return counts; }
};

struct World final : test::PlainWorld {};

struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "alpenglow-imageloop-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const std::string& f) const { return (path / f).string(); }
};

display::Image read(const std::string& file) {
    Diagnostics d;
    auto i = display::readImage(file, d);
    EXPECT_TRUE(i) << file;
    return i ? *i : display::Image();
}

/// 40 x 20 pixels of 2 x 2 samples in the middle of their cells, fov 90: x spans -2 to 2.
std::shared_ptr<scene::Frame> slopeFrame() {
    auto f = std::make_shared<scene::Frame>();
    f->options.xres = 40;
    f->options.yres = 20;
    f->options.projection = "perspective";
    f->options.fov = 90;
    f->options.hider = "hidden";
    f->options.filter = {"box", 1, 1};
    f->options.pixelSamplesX = f->options.pixelSamplesY = 2;
    scene::Param jitter;
    jitter.name = "jitter";
    jitter.numbers = {0};
    f->options.hiderParams = {jitter};
    return f;
}

} // namespace

// Displays that differ in their depth filter share colours and weights.
TEST(ImageLoop, DisplaysOfOneFilterHaveDepthsOfTheirOwn) {
    Folder dir;
    auto f = slopeFrame();
    for (const char* filter : {"min", "max", "average"}) {
        scene::Param p;
        p.name = "filter";
        p.strings = {filter};
        f->options.displays.push_back({dir / (std::string(filter) + ".exr"), "openexr", "rgbaz", {p}, {}});
    }
    RenderSettings s;
    s.allowWrite = true;
    Diagnostics diags;
    Progress progress{ProgressMode::None};
    Renderer renderer(s, test::plainEngine<World>([](const transport::World&) { return std::make_unique<Slope>(); }), diags,
                      progress, {});
    renderer.render(f);
    EXPECT_EQ(diags.errors(), 0);
    const display::Image least = read(dir / "min.exr"), most = read(dir / "max.exr"), mean = read(dir / "average.exr");
    for (const display::Image* i : {&least, &most, &mean}) ASSERT_EQ(i->channels.size(), 5u);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 40; ++x) {
            const float middle = -2 + 4 * (float(x) + 0.5f) / 40; // of the pixel; samples lie a fortieth beside it
            EXPECT_NEAR(least.pixel(x, y)[4], 4 + middle - 0.025, 1e-6);
            EXPECT_NEAR(most.pixel(x, y)[4], 4 + middle + 0.025, 1e-6);
            EXPECT_NEAR(mean.pixel(x, y)[4], 4 + middle, 1e-6);
            for (const display::Image* i : {&least, &most, &mean}) EXPECT_NEAR(i->pixel(x, y)[0], middle, 1e-6);
        }
}

TEST(ImageLoop, ResultsAreKeptFromTaskToTask) {
    Folder dir;
    auto f = slopeFrame();
    RenderSettings s;
    s.output = dir / "a.exr";
    s.threads = 1;
    Diagnostics diags;
    Progress progress{ProgressMode::None};
    int fresh = 0;
    Renderer renderer(s, test::plainEngine<World>([&](const transport::World&) { return std::make_unique<Keeper>(fresh); }),
                      diags, progress, {});
    renderer.render(f);
    EXPECT_EQ(fresh, 1); // of the six tiles
}

} // namespace imageloop_test

// Image samples over a scene of closed forms: the plane z = 4 + x of the image plane.
#include "display/imageio.h"
#include "plain_world.h"
#include "render/renderer.h"
#include "render/rendering.h"
#include "scene/scene.h"
#include <atomic>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>

namespace imageloop_test {
using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

namespace {

struct Slope final : Tracer {
    integrator::Counters counts;
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out,
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
    const integrator::Counters& counters() const override { return counts; }
};

/// Of each pixel x an edge of its own, white to its left: `speed` pixels while the shutter is open, `blur` pixels from the middle
/// of the lens to its rim.
struct Edges final : Tracer {
    integrator::Counters counts;
    double speed, blur;
    Edges(double s, double b) : speed(s), blur(b) {}
    static double edgeOf(int x, double reach) { return -reach + (1 + 2 * reach) * (x + 0.5) / 400; }
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out,
               const StopFlag* stop) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            const integrator::CameraRay& r = rays[i];
            // The lens has a radius of 1 and is in focus at 10, where fov 90 gives the 40 pixels of its height a side of 20.
            const Vec3 p = r.origin + r.direction * (10 / r.direction.z);
            const double x = 200 + 2 * double(p.x) - r.px, lens = r.origin.x;
            const bool white = x < edgeOf(r.px, speed + blur) + speed * r.shutter + blur * lens;
            out[i].color = Color(white ? 1.f : 0.f);
            out[i].opacity = Color(1.f);
        }
        return !*stop;
    }
    const integrator::Counters& counters() const override { return counts; }
};

/// Leaves memory behind in the first result of a call, and counts the calls that find none.
struct Keeper final : Tracer {
    int& fresh;
    integrator::Counters counts;
    explicit Keeper(int& f) : fresh(f) {}
    bool trace(std::span<const integrator::CameraRay>, std::span<integrator::SampleResult> out, const StopFlag*) override {
        fresh += out[0].aovs.capacity() < 100;
        out[0].aovs.reserve(100);
        return true;
    }
    const integrator::Counters& counters() const override { return counts; }
};

/// Counts its samples; each has a colour of its own.
struct Marks final : Tracer {
    std::atomic<size_t>& samples;
    integrator::Counters counts;
    explicit Marks(std::atomic<size_t>& n) : samples(n) {}
    bool trace(std::span<const integrator::CameraRay> rays, std::span<integrator::SampleResult> out, const StopFlag*) override {
        for (size_t i = 0; i < rays.size(); ++i) {
            const integrator::CameraRay& r = rays[i];
            out[i].color = Color(float((r.px * 31 + r.py * 17 + int(r.sample)) % 101));
            out[i].opacity = Color(1.f);
            out[i].z = 1;
        }
        samples += rays.size();
        return true;
    }
    const integrator::Counters& counters() const override { return counts; }
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
    Renderer renderer(s, test::plainEngine<World>([](const world::World&) { return std::make_unique<Slope>(); }), diags, progress,
                      {});
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

namespace {

/// The mean of a pixel with such an edge: over the place, of what covers it. `lens`: of a disc, else of a time.
double meanOf(double edge, double reach, bool lens) {
    double sum = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        const double z = std::clamp(((i + 0.5) / kSteps - edge) / reach, -1.0, 1.0);
        sum += lens ? 0.5 - (z * std::sqrt(1 - z * z) + std::asin(z)) / kPi : 1 - std::max(z, 0.0);
    }
    return sum / kSteps;
}

/// The root of the mean square error of 16,000 pixels of 4 x 4 samples.
double errorOfEdges(double speed, double blur) {
    Folder dir;
    auto f = slopeFrame();
    f->options.xres = 400;
    f->options.yres = 40;
    f->options.pixelSamplesX = f->options.pixelSamplesY = 4;
    f->options.hiderParams.clear();
    if (speed > 0) f->options.shutterClose = 1;
    if (blur > 0) {
        f->options.fstop = 1;
        f->options.focalLength = 2;
        f->options.focalDistance = 10;
    }
    RenderSettings s;
    s.output = dir / "a.exr";
    Diagnostics diags;
    Progress progress{ProgressMode::None};
    Renderer renderer(s, test::plainEngine<World>([&](const world::World&) { return std::make_unique<Edges>(speed, blur); }),
                      diags, progress, {});
    renderer.render(f);
    const display::Image i = read(s.output);
    double sum = 0;
    for (int x = 0; x < 400; ++x) {
        const double exact = meanOf(Edges::edgeOf(x, speed + blur), speed + blur, blur > 0);
        for (int y = 0; y < 40; ++y) sum += (i.pixel(x, y)[0] - exact) * (i.pixel(x, y)[0] - exact);
    }
    return std::sqrt(sum / 16000);
}

} // namespace

// An edge crosses at most 7 of the 16 cells of place and time, a sample in each, whose variance is 1/6 on average where it
// crosses: sqrt(7 / 6) / 16 = .068 where it crosses that many; fewer on average over where it lies. Two scrambles a pixel gave
// .051.
TEST(ImageLoop, TimeAndLensComeFromOneNet) {
    EXPECT_LT(errorOfEdges(1, 0), 0.040);
    EXPECT_LT(errorOfEdges(0, 1), 0.045);
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
    Renderer renderer(s, test::plainEngine<World>([&](const world::World&) { return std::make_unique<Keeper>(fresh); }), diags,
                      progress, {});
    renderer.render(f);
    EXPECT_EQ(fresh, 1); // of the six tiles
}

// A picture of 64 x 300 pixels and 36 samples has more than one band of kBandBytes a thread: no sample is traced twice, and the
// pixels are those of one band.
TEST(ImageLoop, BandsShareTheSamplesBetweenThem) {
    Folder dir;
    auto f = slopeFrame();
    f->options.xres = 64;
    f->options.yres = 300;
    f->options.pixelSamplesX = f->options.pixelSamplesY = 6;
    f->options.filter = {"gaussian", 3, 3};
    ASSERT_GT(size_t(66 * 302 * 36 * 10) * sizeof(float), 3 * kBandBytes);
    std::vector<display::Image> pictures;
    for (const int threads : {1, 2, 32}) {
        RenderSettings s;
        s.output = dir / "a.exr";
        s.threads = threads;
        s.allowWrite = true;
        Diagnostics diags;
        Progress progress{ProgressMode::None};
        std::atomic<size_t> samples{0};
        Renderer renderer(s, test::plainEngine<World>([&](const world::World&) { return std::make_unique<Marks>(samples); }),
                          diags, progress, {});
        renderer.render(f);
        EXPECT_EQ(samples, 66u * 302 * 36);
        pictures.push_back(read(s.output));
    }
    EXPECT_EQ(pictures[0].data, pictures[2].data); // 32 threads have one band
    EXPECT_EQ(pictures[1].data, pictures[2].data);
}

namespace {

/// Stops the run at one of its calls, whose samples are then unfinished.
struct Stopper final : Tracer {
    StopFlag& stop;
    int left;
    integrator::Counters counts;
    Stopper(StopFlag& s, int calls) : stop(s), left(calls) {}
    bool trace(std::span<const integrator::CameraRay>, std::span<integrator::SampleResult> out, const StopFlag*) override {
        if (left-- == 0) stop = 1;
        for (integrator::SampleResult& r : out) r.color = Color(1.f), r.opacity = Color(1.f), r.z = 1;
        return left >= 0;
    }
    const integrator::Counters& counters() const override { return counts; }
};

} // namespace

// Ctrl-C while the first tiles are traced: a picture of an earlier run is better than a black one. Later, what is done is
// written.
TEST(ImageLoop, NothingIsWrittenBeforeAPartIsComplete) {
    for (const int complete : {0, 2}) {
        Folder dir;
        auto f = slopeFrame();
        StopFlag stop = 0;
        RenderSettings s;
        s.output = dir / "a.exr";
        s.threads = 1;
        s.allowWrite = true;
        s.stop = &stop;
        Diagnostics diags;
        Progress progress{ProgressMode::None};
        Renderer renderer(
            s, test::plainEngine<World>([&](const world::World&) { return std::make_unique<Stopper>(stop, complete); }), diags,
            progress, {});
        renderer.render(f);
        EXPECT_TRUE(renderer.outcome().interrupted);
        ASSERT_EQ(diags.all().size(), 1u);
        if (!complete) {
            EXPECT_FALSE(fs::exists(s.output));
            EXPECT_EQ(diags.all()[0].message, "interrupted before any part was complete; no picture is written");
        } else {
            const display::Image i = read(s.output);
            EXPECT_EQ(i.pixel(0, 0)[0], 1);
            EXPECT_EQ(i.pixel(39, 19)[0], 0);
            EXPECT_EQ(diags.all()[0].message, "interrupted: unfinished parts of the picture are black");
        }
    }
}

} // namespace imageloop_test

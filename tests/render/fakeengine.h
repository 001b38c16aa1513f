// The renderer over a scene of closed forms in the engine's place: an emitter whose colour is the place on the image plane.
#pragma once
#include "display/imageio.h"
#include "plain_world.h"
#include "render/renderer.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace renderer_test {
using namespace alpenglow;
using namespace alpenglow::render;
namespace fs = std::filesystem;

/// An imager that sets red to the raster x.
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

inline Engine fakeEngine() {
    return test::plainEngine<FakeWorld>([](const world::World& w) {
        auto t = std::make_unique<FakeTracer>();
        t->outputs = w.settings().outputs;
        return t;
    });
}

/// For pictures; gone with the test.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "alpenglow-renderer-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    std::string operator/(const std::string& f) const { return (path / f).string(); }
};

inline std::shared_ptr<scene::Frame> frameOf(const char* hider, int w = 24, int h = 16) {
    auto f = std::make_shared<scene::Frame>();
    f->options.xres = w;
    f->options.yres = h;
    f->options.projection = "perspective";
    f->options.fov = 90;
    f->options.hider = hider;
    f->options.filter = {"box", 1, 1};
    return f;
}

/// A render with its messages.
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

inline std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline display::Image read(const std::string& file) {
    Diagnostics d;
    auto i = display::readImage(file, d);
    EXPECT_TRUE(i) << file;
    return i ? *i : display::Image();
}

/// Place on the image plane of the middle of a pixel: 24 x 16, fov 90, so y spans -1..1 and x spans -1.5..1.5.
inline float planeX(int x) { return -1.5f + 3 * (float(x) + 0.5f) / 24; }
inline float planeY(int y) { return 1 - 2 * (float(y) + 0.5f) / 16; }

} // namespace renderer_test

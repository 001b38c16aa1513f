// The scenes that are measured render, at a small size; and what they are for is in them. Nothing is timed here.
#include "bench/scene_parts.h"
#include "bench/scene_set.h"
#include "display/imageio.h"
#include "render/progress.h"
#include "render/renderer.h"
#include "ri/reader.h"
#include "scene/scene.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <unistd.h>

namespace alpenglow::bench::scenes_test {
namespace {

struct Folder {
    std::string path = ::testing::TempDir() + "alpenglow_bench_" + std::to_string(getpid());
    explicit Folder(const std::string& more = "") { path += more; }
    ~Folder() { std::filesystem::remove_all(path); }
};

constexpr double kSmall = 0.04;

render::RenderStats rendered(const std::string& folder, const std::string& name, double* mean) {
    Diagnostics diagnostics;
    EXPECT_TRUE(writeBenchScene(name, folder, kSmall, diagnostics));
    render::RenderSettings s;
    s.output = folder + "/" + name + ".exr";
    s.width = 64;
    s.height = 40;
    s.spp = 4;
    s.threads = 1;
    s.allowWrite = true;
    s.shippedShaders = ALPENGLOW_SOURCE_DIR "/shaders";
    s.progress = render::ProgressMode::None;
    render::Progress progress(render::ProgressMode::None);
    render::Renderer renderer(s, render::transportEngine(), diagnostics, progress);
    ri::ReaderOptions options;
    options.overrides = [&](scene::Options& o) { renderer.override(o); };
    renderer.setScene(folder + "/" + name + ".rib");
    ri::RibReader(options, renderer, diagnostics).readFile(folder + "/" + name + ".rib");
    renderer.finish();
    for (const Diagnostic& d : diagnostics.all())
        if (d.severity >= Severity::Warning) ADD_FAILURE() << name << ": " << toString(d);
    std::optional<display::Image> image = display::readImage(s.output, diagnostics);
    *mean = 0;
    if (image)
        for (float v : image->data) *mean += double(v) / double(image->data.size());
    return renderer.stats();
}

class Scenes : public ::testing::TestWithParam<BenchScene> {};

TEST_P(Scenes, Renders) {
    const BenchScene& scene = GetParam();
    Folder folder(scene.name);
    double mean = 0;
    render::RenderStats r = rendered(folder.path, scene.name, &mean);
    EXPECT_EQ(r.width * r.height, 64 * 40);
    EXPECT_EQ(r.nonFinite, 0u);
    EXPECT_GT(mean, 0.01);
    EXPECT_LT(mean, 3);
    EXPECT_GT(r.shading.points, 1000u);
    EXPECT_EQ(r.shading.suspendingKernels, std::string(scene.name) == "waiting" ? 1 : 0);
}

INSTANTIATE_TEST_SUITE_P(All, Scenes, ::testing::ValuesIn(benchScenes()),
                         [](const auto& info) { return std::string(info.param.name); });

// The scenes that are compared with another one differ from it in what they are about, and in nothing else.
TEST(ScenePairs, SameWork) {
    Folder folder("pairs");
    double many = 0, one = 0;
    render::RenderStats a = rendered(folder.path, "fifty_shaders", &many), b = rendered(folder.path, "one_shader", &one);
    EXPECT_EQ(a.rays.at("camera"), b.rays.at("camera"));
    EXPECT_GT(a.shading.batches, b.shading.batches); // points of one shader share batches
    rendered(folder.path, "thousand_lights", &many);
    rendered(folder.path, "ten_lights", &one);
    EXPECT_NEAR(many / one, 1, 0.5); // the same power, at other places
}

TEST(SceneSet, SameBytes) {
    Folder one("one"), two("two");
    Diagnostics d;
    for (const char* name : {"terrain", "mesh", "fifty_shaders", "thousand_lights"}) {
        ASSERT_TRUE(writeBenchScene(name, one.path, kSmall, d) && writeBenchScene(name, two.path, kSmall, d));
        for (const char* kind : {".rib", ".tx"}) {
            const auto bytes = [&](const Folder& f) {
                std::ifstream in(f.path + "/" + name + kind, std::ios::binary);
                return std::string(std::istreambuf_iterator<char>(in), {});
            };
            EXPECT_EQ(bytes(one), bytes(two)) << name << kind;
        }
    }
    EXPECT_FALSE(writeBenchScene("nothing", one.path, 1, d));
}

TEST(SceneParts, Rooms) {
    EXPECT_EQ(partOfSymbol("_ZNK9alpenglow7texture5Level11addBilinearEffNS0_4WrapES2_iifPfb"), kTextures);
    EXPECT_EQ(partOfSymbol("_ZNK9alpenglow5accel5Accel4Impl12intersectOneERKNS0_3RayERNS0_3HitE"), kTraversal);
    EXPECT_EQ(partOfSymbol("_ZNK9alpenglow8geometry11PolygonMesh9makePlaneEj"), kPoints);
    EXPECT_EQ(partOfSymbol("_ZN9alpenglow8services8Services10lightFetchERNS0_12BatchContextEiimiPf"), kLights);
    EXPECT_EQ(partOfSymbol("[libc.so.6]"), kMemory);
    EXPECT_EQ(partOfSymbol("[kernel code]"), kKernels);
    EXPECT_EQ(partOfSymbol("[libz.so.1]"), kOther);
}

TEST(SceneParts, Stages) {
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow7shading9SchedulerINS0_7PathRayEE5spawnEiiRKS2_"), kQueues);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow7shading9SchedulerINS0_7PathRayEE3addEiRKNS_4Vec3E"), kAccumulate);
    EXPECT_EQ(stageOfSymbol("_ZNK9alpenglow5accel5Accel4Impl14nearestInBlockERKNS0_10DirectRaysEjPKfPNS0_3HitE"), kSearch);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow10integrator10RowShading3runERNS0_12BatchContextE"), kSurfaces);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow10integrator13LobeSelection6selectERKNS0_12BatchContextE"), kChoose);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow10integrator13LightSampling14placeOnEmitterEmRKNS0_7EmitterE"), kLightSamples);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow6render4Film3addEiRKNS_4Vec3E"), kCamera);
    EXPECT_EQ(stageOfSymbol("_ZN9alpenglow10integrator12Transparency14continueBehindERKNS0_14SurfaceBindingE"), kElsewhere);
    EXPECT_EQ(stageOfSymbol("[kernel code]"), kShade);
}

} // namespace
} // namespace alpenglow::bench::scenes_test

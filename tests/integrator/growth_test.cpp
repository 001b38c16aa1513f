// Growth of work with depth, memory of suspended frames, interruption.
#include "base/limits.h"
#include "integrator/harness.h"
#include "render/camera.h"
#include "sanitized.h"
#include "scene/scene.h"
#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

namespace growth_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kPlasticBox =
    "WorldBegin\nSides 2\nLightSource \"pointlight\" 1 \"intensity\" 1 \"from\" [0 .5 0]\nSurface \"plastic\" \"Kd\" .5 \"Ks\" "
    ".5\n"
    "Polygon \"P\" [-1 -1 -1  1 -1 -1  1 -1 2  -1 -1 2]\nPolygon \"P\" [-1 1 -1  -1 1 2  1 1 2  1 1 -1]\n"
    "Polygon \"P\" [-1 -1 -1  -1 1 -1  1 1 -1  1 -1 -1]\nPolygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n"
    "Polygon \"P\" [-1 -1 -1  -1 -1 2  -1 1 2  -1 1 -1]\nPolygon \"P\" [1 -1 -1  1 1 -1  1 1 2  1 -1 2]\nWorldEnd\n";
const CameraRay kEye = rayTo({.1f, -.2f, .3f}, {.5f, .3f, 1});

// One lobe a vertex is followed: at most one ray a bounce.
TEST(Growth, RaysAreLinearInDepth) {
    double last = 0;
    for (int depth : {2, 4, 8, 16, 32, 64}) {
        Settings s;
        s.hider = Hider::Path;
        s.roulette = false;
        s.maxDepth = depth;
        Scene scene(kPlasticBox, s);
        Counters c;
        Moments m = scene.estimate(kEye, 500, &c);
        double rays = double(c.diffuse + c.specular) / double(c.paths);
        EXPECT_LE(rays, depth);
        EXPECT_LE(double(c.shadow) / double(c.paths), 2 * (depth + 1));
        EXPECT_TRUE(std::isfinite(m.mean())) << depth;
        EXPECT_EQ(c.nonFinite, 0u);
        // A vertex reflects at most what it receives: the sum over bounces is below the direct light's largest value / (1 - 1/2 -
        // 1/2) only because highlights lose light; it must stop growing.
        if (depth == 64) EXPECT_NEAR(m.mean(), last, .5 * last);
        last = m.mean();
        EXPECT_GT(m.mean(), 0);
    }
}
// What bounces and what goes on through surfaces are one choice: closed spheres of half opacity cost no more rays a bounce than
// opaque ones do. A shader that does not multiply its Ci by Oi gives away more than it receives, and is tamed by what comes
// through.
TEST(Growth, HalfOpaqueSurfacesAreLinearInDepth) {
    writeShader("notpremultiplied", "surface notpremultiplied() { Oi = Os; Ci = Cs * diffuse(faceforward(normalize(N), I)); }\n");
    for (const bool roulette : {false, true}) {
        double rays[2];
        for (int k = 0; k < 2; ++k) {
            Settings s;
            s.hider = Hider::Path;
            s.roulette = roulette;
            s.maxDepth = k ? 24 : 8;
            Scene scene("WorldBegin\nSides 2\nLightSource \"pointlight\" 1 \"intensity\" 1\nSurface "
                        "\"notpremultiplied\"\nOpacity [.5 .5 .5]\n"
                        "Sphere 3 -3 3 360\nSphere 4 -4 4 360\nOpacity [1 1 1]\nSphere 5 -5 5 360\nWorldEnd\n",
                        s);
            Counters c;
            const Moments m = scene.estimate(kEye, 2000, &c);
            EXPECT_TRUE(std::isfinite(m.mean()));
            rays[k] = double(c.diffuse + c.camera) / double(c.paths);
            // Three vertices of the camera; from each a path that passes a surface about as often as it bounces.
            EXPECT_LE(rays[k], 3 * 3 * (s.maxDepth + 1));
            EXPECT_NE(scene.messages().find("more light than it receives"), std::string::npos);
        }
        EXPECT_LE(rays[1] / rays[0], 3.2) << "from depth 8 to 24";
    }
}
// Roulette on, as it is used: a path ends by itself, so rays a sample stop growing where the depth no longer matters.
TEST(Growth, RouletteEndsPaths) {
    double rays[2];
    for (int k = 0; k < 2; ++k) {
        Settings s;
        s.hider = Hider::Path;
        s.maxDepth = k ? 512 : 128;
        Counters c;
        Moments m = Scene(kPlasticBox, s).estimate(kEye, 2000, &c);
        EXPECT_TRUE(std::isfinite(m.mean()));
        EXPECT_EQ(c.nonFinite, 0u);
        rays[k] = double(c.diffuse + c.specular + c.shadow) / double(c.paths);
    }
    EXPECT_NEAR(rays[1] / rays[0], 1, .2);
}
// The published scenes under "path", in affine and in suspending form: bounce rays a sample at most the depth, shadow rays at
// most lights times lobes (three in the standard shaders) a vertex, energy finite and settled, frames of waiting shaders below
// their limit.
class OldScene : public ::testing::TestWithParam<const char*> {
protected:
    size_t lights_ = 0;
    /// One sample of each of 64 x 64 places of the frame.
    Moments see(const std::string& file, const std::string& folder, Settings s, Counters& c) {
        s.texturePaths = {folder};
        Moments m;
        Scene scene(readText(file), s);
        if (!scene.world) return m;
        lights_ = scene.frame->lights.size();
        render::Camera camera(scene.frame->options, scene.diagnostics);
        std::vector<CameraRay> rays;
        for (int y = 0; y < 64; ++y)
            for (int x = 0; x < 64; ++x) {
                rays.push_back(camera.ray((x + .5) / 64 * camera.width(), (y + .5) / 64 * camera.height(), {.5f, .5f}, 0));
                rays.back().px = x;
                rays.back().py = y;
            }
        for (const SampleResult& r : scene.trace(rays, &c)) {
            EXPECT_TRUE(std::isfinite(r.color.x) && std::isfinite(r.color.y) && std::isfinite(r.color.z));
            m.add(r.color);
        }
        EXPECT_GT(c.paths, 0u);
        EXPECT_GT(m.mean(), 0);
        EXPECT_EQ(c.nonFinite, 0u);
        EXPECT_EQ(c.overLimit, 0u);
        EXPECT_LE(c.peakFrameBytes, limits::kFrameBytesPerThread);
        return m;
    }
};
TEST_P(OldScene, GrowsLinearly) {
    const std::string folder = ALPENGLOW_SOURCE_DIR "/../shared/scenes/", file = folder + GetParam() + ".rib";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "the published scenes are not here";
    double last = 0, spread = 0;
    for (int depth : {1, 2, 4, 8, 16, 32}) {
        Settings s;
        s.hider = Hider::Path;
        s.maxDepth = depth;
        s.roulette = false;
        Counters c;
        Moments m = see(file, folder, s, c);
        double paths = double(c.paths);
        EXPECT_LE(double(c.diffuse + c.specular), depth * paths) << depth;
        EXPECT_LE(double(c.shadow), 3 * std::max(1.0, double(lights_)) * (depth + 1) * paths) << depth;
        if (depth == 32) EXPECT_NEAR(m.mean(), last, .05 * last + kZ * spread);
        last = m.mean();
        spread = std::sqrt(2.0) * m.se();
    }
    // Waiting kernels follow every request: two or three a vertex of the first three bounces, and half of what those would send
    // behind them.
    Settings s;
    s.hider = Hider::Path;
    s.suspend = true;
    Counters c;
    Moments m = see(file, folder, s, c);
    EXPECT_LE(double(c.diffuse + c.specular), 27 * 32 * double(c.paths));
    EXPECT_NEAR(m.mean(), last, .1 * last + kZ * std::sqrt(m.se() * m.se() + spread * spread));
    std::printf("%s: largest frames of waiting shaders %zu bytes a thread, %.1f rays a sample\n", GetParam(), c.peakFrameBytes,
                double(c.diffuse + c.specular + c.shadow) / double(c.paths));
}
INSTANTIATE_TEST_SUITE_P(Published, OldScene,
                         ::testing::Values("bulb", "cubits", "showquads", "spot", "teapot", "tetra", "uteapot", "val_poly"),
                         [](const auto& i) { return std::string(i.param); });

TEST(Growth, SuspendedFramesStayBounded) {
    writeShader("branchy", R"(surface branchy() {
    normal Nf = faceforward(normalize(N), I);
    color a = trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2);
    color b = 0;
    if (comp(a, 0) >= 0)
        b = trace(P, reflect(normalize(I), Nf), "distribution", "cosine", "samplecone", .3);
    Oi = 1;
    Ci = .1 + .4 * a * b;
}
)");
    std::string rib = kPlasticBox;
    rib.replace(rib.find("\"plastic\" \"Kd\" .5 \"Ks\" .5"), 26, "\"branchy\"");
    Settings s;
    s.hider = Hider::Path;
    s.roulette = false;
    s.maxDepth = 7;
    Scene scene(rib, s);
    EXPECT_GT(scene.world->facts().suspending, 0);
    Counters c;
    Moments m = scene.estimate(kEye, 300, &c);
    EXPECT_GT(c.peakFrameBytes, 0u);
    EXPECT_LE(c.peakFrameBytes, limits::kFrameBytesPerThread);
    EXPECT_EQ(c.overLimit, 0u);
    // Constant in all directions: x = .1 + .4 x^2 iterated from 0 at the deepest bounce.
    double x = .1; // depth 7: traces find nothing
    for (int i = 0; i < 7; ++i) x = .1 + .4 * x * x;
    EXPECT_NEAR(m.mean(), x, 1e-5);
}
// A shader that waits for eight rays at every point, in a closed box where it sends on four fifths of what arrives: .2 + .8 L = L
// = 1 but for depth 32 (.8^33 = .0006). The sum over rays must be finite work, and right.
TEST(Growth, ManyRaysOfAWaitingShaderStayFinite) {
    writeShader("eight", R"(surface eight() {
    normal Nf = faceforward(normalize(N), I);
    color sum = 0;
    float k;
    for (k = 0; k < 8; k += 1) {
        sum += .1 * trace(P, vector(Nf), "distribution", "cosine", "samplecone", PI / 2);
        if (comp(sum, 0) < -1) sum = 0;
    }
    Oi = 1;
    Ci = .2 + sum;
}
)");
    std::string rib = kPlasticBox;
    rib.replace(rib.find("\"plastic\" \"Kd\" .5 \"Ks\" .5"), 26, "\"eight\"");
    Settings s;
    s.hider = Hider::Path;
    s.maxDepth = 32;
    Scene scene(rib, s);
    ASSERT_GT(scene.world->facts().suspending, 0);
    Counters c;
    Moments m = scene.estimate(kEye, 100, &c);
    EXPECT_LT(double(c.diffuse) / double(c.paths), 3000);
    EXPECT_NEAR(m.mean(), 1, 4.753 * m.se() + .0006);
    EXPECT_LT(m.se(), .1);
}
/// What the process has of the machine's memory, in bytes; 0 where that is not known.
size_t residentBytes() {
    std::ifstream f("/proc/self/statm");
    size_t all = 0, resident = 0;
    f >> all >> resident;
    return resident * 4096;
}

/// Traces rays that take far longer than `wait` ms, asks to stop after those, and expects the end within the 0.2 s that the issue
/// asks for, without more than `most` bytes more than before. Time of the processor: what else the machine has to do is not ours.
void expectPromptStop(Scene& scene, const std::vector<CameraRay>& rays, int wait = 150, size_t most = size_t(512) << 20) {
    std::vector<SampleResult> out(rays.size());
    StopFlag stop{0};
    std::clock_t asked = 0;
    const size_t before = residentBytes();
    size_t peak = before;
    std::thread killer([&] {
        for (int waited = 0; waited < wait; waited += 10) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            peak = std::max(peak, residentBytes());
        }
        asked = std::clock();
        stop = 1;
    });
    Integrator i(scene.world, scene.diagnostics);
    bool done = i.trace(rays, out, &stop);
    const std::clock_t ended = std::clock();
    killer.join();
    EXPECT_FALSE(done);
    EXPECT_LT(double(ended - asked) / CLOCKS_PER_SEC, kSanitized ? 2 : .2);
    EXPECT_LT(peak - before, most * (kSanitized ? 4 : 1));
}

TEST(Stop, EndlessLoopsEndPromptly) {
    writeShader("forever",
                "surface forever() { float x = 0, k = 0; while (1) { k += 1; x += noise(k, .5); } Ci = x; Oi = 1; }\n");
    Scene scene("WorldBegin\nSurface \"forever\"\nSides 2\nSphere 1 -1 1 360\nWorldEnd\n");
    ASSERT_TRUE(scene.world);
    std::vector<CameraRay> rays(2000, rayTo({0, 0, -3}, {0, 0, 0}));
    expectPromptStop(scene, rays);
}
TEST(Stop, ManyRaysEndPromptly) {
    Scene scene(kPlasticBox, [] {
        Settings s;
        s.hider = Hider::Path;
        s.roulette = false;
        s.maxDepth = 5000;
        return s;
    }());
    std::vector<CameraRay> rays(60000, kEye);
    expectPromptStop(scene, rays);
}

// 256 samples nested four deep are four thousand million rays a point: they take what they take, in bounded memory, and end when
// they are asked to.
TEST(Stop, NestedSamplesEndPromptlyInBoundedMemory) {
    const char* const kBodies[][2] = {
        {"gather", "color c = 0, sum = 0; gather(\"illuminance\", P, -P, PI / 2, 256, \"surface:Ci\", c) sum += c / 256; else "
                   "sum += 1 / 256;"},
        {"told", "color c = 0, sum = 0; float f = 0; gather(\"\", P, -P, PI / 2, 256, \"surface:Ci\", c, \"surface:shown\", f) "
                 "sum += c / 256 + f * 1e-6;"},
        {"trace", "color sum = trace(P, vector(-P), \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", 256); if "
                  "(comp(sum, 0) > 2) sum = 0;"},
        {"indirect", "color sum = indirectdiffuse(P, vector(-P), 256); if (comp(sum, 0) > 2) sum = 0;"},
        {"inside",
         "color c = 0, sum = 0; gather(\"\", P, -P, 1, 256) { gather(\"\", P, -P, 1, 256) { gather(\"\", P, -P, 1, 256) {"
         " gather(\"\", P, -P, 1, 256, \"surface:Ci\", c) sum += c * 1e-9; } } }"}};
    // Nightly every body under every hider; else each body under one, each hider with one or two.
    const Hider hiders[] = {Hider::Path, Hider::Hidden, Hider::Raytrace};
    size_t turn = 0;
    for (const auto& pair : kBodies) {
        const size_t chosen = turn++ % 3;
        const char *const name = pair[0], *const body = pair[1];
        writeShader(std::string("deep") + name, "surface deep" + std::string(name) + "(output varying float shown = 0) { " +
                                                    std::string(body) + " shown = comp(sum, 0); Oi = 1; Ci = .1 + .5 * sum; }\n");
        for (const Hider h : hiders) {
            if (!nightly() && h != hiders[chosen]) continue;
            Settings s;
            s.hider = h;
            s.maxDepth = 4;
            s.roulette = false;
            Scene scene("WorldBegin\nSides 2\nAttribute \"trace\" \"int maxdiffusedepth\" 4 \"int maxspeculardepth\" 4\n"
                        "Attribute \"visibility\" \"int diffuse\" 1 \"int specular\" 1 \"int transmission\" 1\nSurface \"deep" +
                            std::string(name) + "\"\nSphere 1 -1 1 360\nWorldEnd\n",
                        s);
            ASSERT_TRUE(scene.world);
            SCOPED_TRACE(std::string(name) + " " + std::to_string(int(h)));
            expectPromptStop(scene, std::vector<CameraRay>(2000, rayTo({0, 0, 0}, {.1f, .2f, 1})), 600);
        }
    }
}

// Counts that ask for nothing, for no number, or for far too much: a message, a value that is finite, and a bounded number of
// rays.
TEST(Growth, CountsThatMakeNoSense) {
    const struct {
        const char *name, *call;
    } kCalls[] = {{"trace", "trace(P, up, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samples\", k)"},
                  {"indirect", "indirectdiffuse(P, up, k)"},
                  {"occlusion", "color occlusion(P, up, k)"},
                  {"transmission", "transmission(P, P + up, \"samplecone\", .5, \"samples\", k)"},
                  {"environment", "environment(\"raytrace\", up, \"samples\", k, \"samplecone\", 1)"}};
    for (const auto& [name, call] : kCalls) {
        writeShader(std::string("senseless") + name, "surface senseless" + std::string(name) +
                                                         "(float n = 1) { vector up = vector(0, 0, -1); float k = n; "
                                                         "if (n == 77) k = 0 * sqrt(-1 - n); Oi = 1; Ci = " +
                                                         call + "; }\n");
        for (const char* n : {"0", "-1", "77", "1e9"}) {
            Settings s;
            s.hider = Hider::Path;
            Scene scene("WorldBegin\nSides 2\nSurface \"senseless" + std::string(name) + "\" \"n\" " + n +
                            "\nPolygon \"P\" [-1 -1 1  1 -1 1  1 1 1  -1 1 1]\nWorldEnd\n",
                        s);
            ASSERT_TRUE(scene.world);
            Counters c;
            const CameraRay ray = rayTo({0, 0, 0}, {.1f, .2f, 1});
            const Color got = scene.trace({&ray, 1}, &c)[0].color;
            EXPECT_TRUE(std::isfinite(got.x)) << name << " " << n;
            const uint64_t rays = c.diffuse + c.specular + c.transmission + c.shadow;
            EXPECT_LE(rays, 4096u * 2) << name << " " << n;
            EXPECT_EQ(scene.messages().find("limit of 4096 rays") != std::string::npos, std::string(n) == "1e9")
                << name << " " << n << scene.messages();
        }
    }
}

} // namespace

} // namespace growth_test

// How deep paths go.
#include "base/limits.h"
#include "integrator/harness.h"

namespace path_limits_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

TEST(PathLimits, DepthThatTheSceneAsksFor) {
    // Between mirrors a path ends only where it must. 2^31 - 1 is no float: it becomes 2^31, which no int holds.
    writeShader("mirror", "surface mirror() { Ci = trace(P, reflect(normalize(I), normalize(N))); Oi = 1; }\n");
    for (auto [asked, want] : {std::pair{"12", 12}, {"1000000", limits::kPathDepth}, {"2147483647", limits::kPathDepth}}) {
        Settings s;
        s.roulette = false;
        s.hider = Hider::Path;
        Scene scene(std::string("Option \"trace\" \"int maxdepth\" [") + asked +
                        "]\nWorldBegin\nSurface \"mirror\"\nSides 2\nSphere 1 -1 1 360\nWorldEnd\n",
                    s);
        ASSERT_TRUE(scene.world);
        CameraRay ray = rayTo({0, 0, 0}, {0.3f, 0.4f, 1});
        Counters c;
        scene.trace({&ray, 1}, &c);
        EXPECT_EQ(c.depthMax, want) << asked;
        EXPECT_EQ(c.depthCap, 1u);
    }
}

TEST(PathLimits, TransparentLayers) {
    // Discs that let everything through: a ray follows so many of them and no more; what is cut is counted.
    writeShader("clear", "surface clear() { Ci = 0; Oi = 0; }\n");
    std::string rib = "Hider \"path\"\nWorldBegin\nSurface \"clear\"\nSides 2\n";
    for (int i = 0; i < limits::kPathDepth / 32 + 50; ++i) rib += "Disk " + std::to_string(1 + i) + " 100 360\n";
    Scene scene(rib + "WorldEnd\n");
    ASSERT_TRUE(scene.world);
    CameraRay ray = rayTo({0.3f, 0.4f, 0}, {0.3f, 0.4f, 1});
    Counters c;
    scene.trace({&ray, 1}, &c);
    EXPECT_EQ(c.depthCap, 1u);
}

TEST(PathLimits, RaysOfALoopThatDoesNotWait) {
    // Requests of an affine kernel are kept until it is done: so many of them and no more. The frame is given up with a message.
    // Both hiders nightly: RaysThatDoNotFitAtOnce comes to the same limit under both.
    writeShader("greedy", "surface greedy() { float i; color c = 0; for (i = 0; i < 1e7; i += 1) c += trace(P, reflect(I, N)); "
                          "Oi = 1; Ci = c; }\n");
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        if (h == Hider::Hidden && !nightly()) continue;
        Settings s;
        s.hider = h;
        Scene scene("WorldBegin\nSurface \"greedy\"\nSphere 1 -1 1 360\nWorldEnd\n", s);
        ASSERT_TRUE(scene.world);
        ASSERT_EQ(scene.world->facts().suspending, 0);
        const CameraRay ray = rayTo({0, 0, -3}, {0, 0, 0});
        EXPECT_THROW(scene.trace({&ray, 1}), std::bad_alloc);
        EXPECT_NE(scene.messages().find("more rays at one point than fit into " + std::to_string(limits::kRequestBytes >> 20)),
                  std::string::npos)
            << scene.messages();
        EXPECT_NE(scene.messages().find("greedy.sl:1:"), std::string::npos) << scene.messages();
    }
}

TEST(PathLimits, RaysThatDoNotFitAtOnce) {
    // 512 points with 3,000 requests each need more than limits::kRequestBytes; a few points at a time do not.
    writeShader("white", "surface white() { Oi = 1; Ci = 1; }\n");
    writeShader("hungry",
                "surface hungry() { float i; color c = 0; for (i = 0; i < 3000; i += 1) c += trace(P, vector(0, 0, -1)); "
                "Oi = 1; Ci = c / 3000; }\n");
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        Settings s;
        s.hider = h;
        Scene scene("WorldBegin\nSides 2\nSurface \"hungry\"\nPolygon \"P\" [-9 -9 2  9 -9 2  9 9 2  -9 9 2]\n"
                    "Surface \"white\"\nPolygon \"P\" [-9 -9 -5  9 -9 -5  9 9 -5  -9 9 -5]\nWorldEnd\n",
                    s);
        ASSERT_TRUE(scene.world);
        ASSERT_EQ(scene.world->facts().suspending, 0);
        const std::vector<CameraRay> rays(size_t(limits::kSliceRays / 8), rayTo({.1f, .2f, 0}, {.1f, .2f, 1}));
        Counters c;
        for (const SampleResult& r : scene.trace(rays, &c)) ASSERT_NEAR(r.color.x, 1, 1e-5);
        EXPECT_EQ(c.camera, rays.size()); // what was begun and done again is not in the figures
        EXPECT_EQ(scene.messages(), "");
    }
}

TEST(PathLimits, FramesOfWaitingShaders) {
    // An array that must survive a trace() lies in the frame of the strip: 64 kB a point. What waits at one time is bounded all
    // the same.
    writeShader("bigframe", "surface bigframe() {\n    matrix m[1000]; float i; color c = 0;\n    for (i = 0; i < 1000; i += 1) "
                            "m[i] = matrix (i + u);\n"
                            "    c = trace(P, reflect(normalize(I), -normalize(N)));\n    if (comp(c, 0) < 5) c += "
                            "comp(m[mod(floor(1000 * (u + comp(c, 0))), 1000)], 0, 0) * 0;\n"
                            "    Oi = 1; Ci = .25 + .5 * c;\n}\n");
    Settings s;
    s.hider = Hider::Raytrace;
    s.maxDepth = 6;
    Scene scene("Option \"trace\" \"int maxdepth\" [6]\nWorldBegin\nSurface \"bigframe\"\nSides 2\nAttribute \"trace\" \"int "
                "maxspeculardepth\" [6]\nSphere 1 -1 1 360\nWorldEnd\n",
                s);
    ASSERT_TRUE(scene.world);
    ASSERT_GT(scene.world->facts().suspending, 0) << scene.messages();
    std::vector<CameraRay> rays;
    for (int i = 0; i < 2000; ++i) rays.push_back(rayTo({0, 0, 0}, {.5f + .0001f * float(i), .4f, 1}));
    Counters c;
    const auto results = scene.trace(rays, &c);
    EXPECT_GT(c.peakFrameBytes, 16u * 64000u);
    EXPECT_LE(c.peakFrameBytes, limits::kFrameBytesPerThread);
    EXPECT_EQ(c.overLimit, 0u);
    const float want = .25f * (1 - std::pow(.5f, 7.f)) / .5f; // the last ray finds nothing
    for (const SampleResult& r : results) EXPECT_NEAR(r.color.x, want, 1e-5f);
}

} // namespace path_limits_test

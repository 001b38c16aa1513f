// How deep paths go.
#include "base/limits.h"
#include "transport/harness.h"

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

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

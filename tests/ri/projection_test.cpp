// Projections: by name, and by matrices in front of the world.
#include "collect.h"
#include "scene/scene.h"
#include <cmath>

namespace projection_test {

using namespace alpenglow;
using namespace alpenglow::ri;

namespace {
void expectNear(const Matrix& a, const Matrix& b) {
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(a.m[i][k], b.m[i][k], 1e-9) << i << " " << k;
}
} // namespace

TEST(Projection, OfMatricesInFrontOfTheWorld) {
    for (const char* name : {"", "Projection \"null\" ", "Projection \"orthographic\" "}) {
        auto c = read(std::string(name) + "Perspective 60 Translate 0 1 5 WorldBegin Sphere 1 -1 1 360 WorldEnd");
        EXPECT_EQ(c->count(), 0u) << c->messages();
        const scene::Options& o = c->frame().options;
        EXPECT_EQ(o.projection, "perspective");
        EXPECT_NEAR(o.fov, 60, 1e-5);
        EXPECT_FALSE(o.screenWindow);
        expectNear(o.worldToCamera.first(), translateMatrix(0, 1, 5));
    }
    // Twice as wide: the window shrinks.
    auto c = read("Format 200 100 1 Scale 2 1 1 Perspective 90 Translate 0 0 5 WorldBegin Sphere 1 -1 1 360 WorldEnd");
    const scene::Options& o = c->frame().options;
    EXPECT_NEAR(o.fov, 90, 1e-5);
    ASSERT_TRUE(o.screenWindow);
    EXPECT_NEAR((*o.screenWindow)[0], -1, 1e-6); // 2, halved
    EXPECT_NEAR((*o.screenWindow)[3], 1, 1e-6);
    // Without a perspective all stays.
    c = read("Scale 2 1 1 Translate 0 0 5 WorldBegin Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->frame().options.projection, "orthographic");
}

TEST(Projection, StereoIsAPairOfPerspectives) {
    auto c = read("Projection \"stereo\" \"fov\" 40 \"float eyeseparation\" .1 WorldBegin Sphere 1 -1 1 360 WorldEnd");
    EXPECT_EQ(c->count(), 0u) << c->messages();
    const scene::Options& o = c->frame().options;
    EXPECT_EQ(o.projection, "perspective");
    EXPECT_EQ(o.fov, 40);
    ASSERT_TRUE(scene::find(o.projectionParams, "stereo"));
    EXPECT_EQ(scene::find(o.projectionParams, "stereo")->strings[0], "sidebyside");
    EXPECT_EQ(scene::find(o.projectionParams, "eyeseparation")->numbers[0], 0.1f);
}

TEST(Format, PixelsHaveAnAspectThatPicturesCanState) {
    for (const char* aspect : {"1e-6", "1e6", "2"}) EXPECT_TRUE(read("Format 16 12 " + std::string(aspect))->ok) << aspect;
    for (const char* aspect : {"1e7", "9e-7"}) {
        auto c = read("Format 16 12 " + std::string(aspect) + " WorldBegin Sphere 1 -1 1 360 WorldEnd");
        EXPECT_EQ(c->only().code, Rie::Range) << aspect;
        EXPECT_EQ(c->frame().options.xres, 16);
        EXPECT_EQ(c->frame().options.pixelAspect, 1);
    }
}

} // namespace projection_test

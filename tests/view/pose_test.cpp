// The camera of a view against matrices worked out by hand. Camera space is left-handed: +x right, +y up, +z into the scene.
#include "scene/scene.h"
#include "view/pose.h"
#include <cmath>
#include <gtest/gtest.h>

namespace pose_test {

using namespace alpenglow;
using view::Pose;

namespace {

scene::Options looking(const Matrix& view) {
    scene::Options o;
    o.projection = "perspective";
    o.fov = 90;
    o.xres = 200;
    o.yres = 100;
    o.worldToCamera = scene::Transform(view);
    return o;
}

Vec3d seen(const Pose& p, Vec3d world) { return transformPoint(p.view(), world); }

void expectNear(Vec3d a, Vec3d b) {
    EXPECT_NEAR(a.x, b.x, 1e-9);
    EXPECT_NEAR(a.y, b.y, 1e-9);
    EXPECT_NEAR(a.z, b.z, 1e-9);
}

TEST(Pose, IsTheScenesAtFirst) {
    scene::Options o = looking(translateMatrix(1, 2, 7)), same = o;
    const Pose p(o);
    EXPECT_FALSE(p.moved());
    p.apply(same);
    EXPECT_EQ(same.worldToCamera.first(), o.worldToCamera.first());
}

TEST(Pose, OrbitTurnsTheSceneAboutWhatIsInTheMiddle) {
    Pose p(looking(translateMatrix(0, 0, 5))); // the origin of the world is 5 away, and so the pivot
    p.orbit(90, 0);                            // what is at the front goes to the right
    expectNear(seen(p, {0, 0, 0}), {0, 0, 5});
    expectNear(seen(p, {0, 0, -1}), {1, 0, 5});
    expectNear(seen(p, {0, 1, 0}), {0, 1, 5});
    Pose q(looking(translateMatrix(0, 0, 5)));
    q.orbit(0, 90); // what is at the front goes down, as a drag downward has it
    expectNear(seen(q, {0, 0, -1}), {0, -1, 5});
    EXPECT_TRUE(q.moved());
}

TEST(Pose, OrbitKeepsTheWorldUpright) {
    // A world whose z is up, as many have it.
    const Matrix zUp = rotateMatrix(-90, 1, 0, 0) * translateMatrix(0, 0, 4);
    const Vec3d up = transformVector(zUp, {0, 0, 1});
    Pose p(looking(zUp));
    for (int i = 0; i < 8; ++i) p.orbit(17, 5);
    for (int i = 0; i < 8; ++i) p.orbit(-17, -5);
    const Vec3d after = transformVector(p.view(), {0, 0, 1});
    EXPECT_NEAR(after.x, up.x, 1e-9); // never leans to a side
    for (int i = 0; i < 36; ++i) p.orbit(10, 0);
    expectNear(transformVector(p.view(), {0, 0, 1}), after); // once round
}

TEST(Pose, DollyGoesNearerByAFactor) {
    Pose p(looking(translateMatrix(0, 0, 5)));
    p.dolly(2);
    expectNear(seen(p, {0, 0, 0}), {0, 0, 2.5});
    p.dolly(0.5);
    expectNear(seen(p, {0, 0, 0}), {0, 0, 5});
    p.dolly(0);
    p.dolly(NAN);
    expectNear(seen(p, {0, 0, 0}), {0, 0, 5});
}

TEST(Pose, PanMovesByPartsOfThePictureAtThePivot) {
    Pose p(looking(translateMatrix(0, 0, 5)));
    p.setDistance(10); // 90 degrees over the shorter side, 100 pixels: 20 high at 10
    p.pan(0.25, -0.5);
    expectNear(seen(p, {0, 0, 0}), {5, -10, 5});
    p.setDistance(-3);
    p.setDistance(INFINITY);
    p.pan(0.05, 0);
    expectNear(seen(p, {0, 0, 0}), {6, -10, 5});
}

TEST(Pose, WithoutPerspectiveNearerIsLarger) {
    scene::Options o = looking(translateMatrix(0, 0, 5));
    o.projection = "orthographic";
    Pose p(o);
    p.dolly(4);
    p.apply(o);
    EXPECT_EQ(o.worldToCamera.first(), translateMatrix(0, 0, 5));
    ASSERT_TRUE(o.screenWindow);
    EXPECT_EQ(*o.screenWindow, (std::vector<float>{-.5f, .5f, -.25f, .25f})); // of -2 2 -1 1
}

TEST(Pose, AMovingCameraKeepsItsWay) {
    scene::Options o = looking(translateMatrix(0, 0, 5));
    o.worldToCamera.times = {0, 1};
    o.worldToCamera.keys = {translateMatrix(0, 0, 5), translateMatrix(3, 0, 5)};
    Pose p(o);
    p.orbit(90, 0);
    p.apply(o);
    expectNear(transformPoint(o.worldToCamera.keys[0], {0, 0, -1}), {1, 0, 5});
    // 3 to the right of where the turned scene would be is 3 farther away, as the turn has it.
    expectNear(transformPoint(o.worldToCamera.keys[1], {0, 0, -1}), {1, 0, 5 + 3});
}

TEST(Pose, StaysWhereItWasWhenTheSceneIsReadAgain) {
    Pose old(looking(translateMatrix(0, 0, 5)));
    old.orbit(90, 0);
    Pose p(looking(translateMatrix(0, 0, 5)));
    p.keepFrom(old);
    expectNear(seen(p, {0, 0, -1}), {1, 0, 5});
    Pose still(looking(translateMatrix(0, 0, 9)));
    still.keepFrom(Pose(looking(translateMatrix(0, 0, 5)))); // nobody had moved it: the file's new place counts
    expectNear(seen(still, {0, 0, 0}), {0, 0, 9});
}

/// Notes the rays that arrive.
struct Notes final : render::Tracer {
    std::vector<integrator::CameraRay> rays;
    integrator::Counters none;
    bool trace(std::span<const integrator::CameraRay> r, std::span<integrator::SampleResult>, const StopFlag*) override {
        rays.assign(r.begin(), r.end());
        return true;
    }
    const integrator::Counters& counters() const override { return none; }
};

TEST(Pose, RaysGoToWhereTheWorldWasBuilt) {
    const Pose built(looking(translateMatrix(0, 0, 5)));
    Pose now = built;
    now.orbit(90, 0);
    auto notes = std::make_unique<Notes>();
    Notes* seen = notes.get();
    auto tracer = view::turned(std::move(notes), now.to(built));
    integrator::CameraRay r;
    r.origin = {0, 0, 0};
    r.direction = {0, 0, 1};
    integrator::SampleResult result;
    tracer->trace({&r, 1}, {&result, 1}, nullptr);
    ASSERT_EQ(seen->rays.size(), 1u);
    // The eye went round to the world's left: it looks along +x at a scene that is where it was.
    EXPECT_NEAR(seen->rays[0].origin.x, -5, 1e-6);
    EXPECT_NEAR(seen->rays[0].origin.z, 5, 1e-6);
    EXPECT_NEAR(seen->rays[0].direction.x, 1, 1e-6);
    EXPECT_NEAR(seen->rays[0].direction.z, 0, 1e-6);
}

} // namespace

} // namespace pose_test

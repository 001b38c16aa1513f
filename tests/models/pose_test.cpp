// Models at a time, compared with closed forms: keys, turns along the sphere, skins, morph targets.
#include "models/check.h"
#include "models/pose.h"
#include <cmath>
#include <gtest/gtest.h>

namespace models_pose_test {

using namespace alpenglow;
using namespace alpenglow::models;

namespace {

Model moved(Channel c) {
    Model m;
    m.nodes.resize(2);
    m.nodes[1].parent = 0;
    m.nodes[1].translation[0] = 10;
    m.roots = {0};
    c.node = 0;
    m.animations.push_back({"a", {std::move(c)}});
    check(m);
    EXPECT_TRUE(m.notes.empty());
    return m;
}

Vec3d originOf(const Pose& p, size_t node) { return transformPoint(p.world[node], Vec3d(0.0)); }

void expectNear(Vec3d a, Vec3d b) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], 1e-6);
}

} // namespace

TEST(ModelPose, MovesWhatHangsOnANode) {
    const Model m = moved({kNone, Path::Translation, Interpolation::Linear, {1, 3}, {0, 0, 0, 0, 4, 0}});
    expectNear(originOf(poseAt(m, 0, 2), 1), {10, 2, 0});
    expectNear(originOf(poseAt(m, 0, 0), 1), {10, 0, 0}); // held before the first key
    expectNear(originOf(poseAt(m, 0, 9), 1), {10, 4, 0}); // and behind the last
    expectNear(originOf(poseAt(m, kNone, 2), 1), {10, 0, 0});
    EXPECT_EQ(lastKey(m.animations[0]), 3);
}

TEST(ModelPose, TurnsAlongTheSphere) {
    const float h = std::sqrt(.5f);
    // Nothing to a quarter turn about z, given with the other sign: the shorter way is taken.
    const Model m = moved({kNone, Path::Rotation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 0, 0, -h, -h}});
    for (const double u : {0., .25, .5, 1.}) {
        const double a = u * kPi / 2;
        expectNear(originOf(poseAt(m, 0, u), 1), {10 * std::cos(a), 10 * std::sin(a), 0});
    }
}

TEST(ModelPose, StepsAndCubicKeys) {
    const Model step = moved({kNone, Path::Scale, Interpolation::Step, {0, 1}, {1, 1, 1, 3, 1, 1}});
    expectNear(originOf(poseAt(step, 0, .99), 1), {10, 0, 0});
    expectNear(originOf(poseAt(step, 0, 1), 1), {30, 0, 0});
    // x = t^3 from 0 to 2: tangents 0 and 12 in value per second, which Hermite's cubic gives exactly.
    const Model cubic =
        moved({kNone, Path::Translation, Interpolation::Cubic, {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 12, 0, 0}});
    for (const double t : {.5, 1., 1.5}) expectNear(originOf(poseAt(cubic, 0, t), 0), {t * t * t, 0, 0});
}

TEST(ModelPose, SkinsFollowTheirJoints) {
    Model m;
    m.nodes.resize(3);
    m.nodes[0].translation[1] = 100; // of the mesh: does not count (glTF 2.0, 3.7.3.3)
    m.nodes[1].translation[0] = 1;
    m.nodes[2].translation[2] = 2;
    Part p;
    p.P = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    p.N = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    p.corners = {0, 1, 2};
    p.influences = 2;
    p.joints = {0, 1, 0, 1, 0, 1};
    p.weights = {1, 0, 0, 1, .25f, .75f};
    m.meshes.push_back({"", {p}, {}, kNone});
    m.skins.push_back({{1, 2}, {}});
    m.nodes[0].meshes = {0};
    m.nodes[0].skin = 0;
    m.roots = {0, 1, 2};
    check(m);
    EXPECT_TRUE(m.notes.empty());
    const Shape s = shapeAt(m, poseAt(m, kNone, 0), 0, m.meshes[0], m.meshes[0].parts[0]);
    EXPECT_EQ(s.P, (std::vector<float>{1, 0, 0, 1, 0, 2, .25f, 1, 1.5f}));
    EXPECT_EQ(s.N, p.N);
}

TEST(ModelPose, TargetsAddUp) {
    Model m;
    m.nodes.resize(1);
    Part p;
    p.P = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    p.corners = {0, 1, 2};
    p.targets.resize(2);
    p.targets[0].P = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    p.targets[1].P = {2, 0, 0, 0, 0, 0, 0, 0, 0};
    m.meshes.push_back({"", {p}, {.5, .5}, kNone});
    m.nodes[0].meshes = {0};
    m.roots = {0};
    m.animations.push_back({"", {{0, Path::Weights, Interpolation::Linear, {0, 1}, {0, 0, 1, 0}}}});
    check(m);
    EXPECT_TRUE(m.notes.empty());
    const Part& part = m.meshes[0].parts[0];
    EXPECT_EQ(shapeAt(m, poseAt(m, kNone, 0), 0, m.meshes[0], part).P, (std::vector<float>{1, 0, .5f, 1, 0, .5f, 0, 1, .5f}));
    EXPECT_EQ(shapeAt(m, poseAt(m, 0, .25), 0, m.meshes[0], part).P, (std::vector<float>{0, 0, .25f, 1, 0, .25f, 0, 1, .25f}));
}

} // namespace models_pose_test

// The octree of a point cloud and the hemisphere of a point alone, against form factors and closed forms.
#include "pointcloud/hemisphere.h"
#include "pointcloud/limits.h"
#include "pointcloud/make.h"
#include <gtest/gtest.h>

namespace hemisphere_test {

namespace {

using namespace alpenglow;
using pointcloud::DiskSides;
using pointcloud::HemisphereQuery;
using pointcloud::PointCloud;
using pointcloud::PointOctree;

/// Squares of a rectangle about a middle, with half sides a and b; light (r, g, b).
void addRectangle(PointCloud& c, const Vec3& middle, const Vec3& a, const Vec3& b, int n, const Color& light = Color(1)) {
    if (c.channels.empty())
        c.channels = {{"_area", pointcloud::ChannelType::Float}, {"_radiosity", pointcloud::ChannelType::Color}};
    const Vec3 normal = normalize(cross(a, b));
    const float area = 4 * length(cross(a, b)) / float(n * n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const Vec3 p = middle + a * (float(2 * i + 1) / float(n) - 1) + b * (float(2 * j + 1) / float(n) - 1);
            const float row[4] = {area, light.x, light.y, light.z};
            c.add(p, normal, std::sqrt(area / 2), row);
        }
}

struct Seen {
    float blocked;
    Color light;
};
Seen look(const PointCloud& c, HemisphereQuery q) {
    pointcloud::Hemisphere h;
    const PointOctree o(c, "_radiosity");
    h.begin(q);
    h.add(o);
    h.finish();
    return {h.blocked(), h.light()};
}

/// The form factor of a rectangle, from a point below one corner, at height h, sides a and b (Howell's catalogue, B-3).
double cornerFactor(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

// A square straight above: four corners of a known factor. Clusters are squares of up to .1 steradian at the default, which do
// not fit together exactly: up to .03 is between them; a fifth of that angle has a third of it.
TEST(PointBased, ARectangleHasItsFormFactor) {
    for (const float height : {.3f, 1.f, 3.f}) {
        PointCloud c;
        addRectangle(c, {0, 0, height}, {1, 0, 0}, {0, -1, 0}, 40, Color(.2f, .4f, .8f));
        const double exact = 4 * cornerFactor(1, 1, height);
        for (const float solid : {.1f, .02f, .004f}) {
            HemisphereQuery q;
            q.N = {0, 0, 1};
            q.maxSolidAngle = solid;
            const Seen s = look(c, q);
            EXPECT_NEAR(s.blocked, exact, solid > .05f ? .03 : .012) << height << " " << solid;
            EXPECT_NEAR(s.light.y, .4 * s.blocked, .004);
        }
    }
}

// From inside of a closed ball nothing is open, but for what is between clusters (.05); and with sides the other way nothing
// blocks.
TEST(PointBased, AClosedBallClosesAll) {
    PointCloud c;
    c.channels = {{"_area", pointcloud::ChannelType::Float}, {"_radiosity", pointcloud::ChannelType::Color}};
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const double z = 1 - (2 * i + 1) / double(n), t = i * 2.399963229728653, r = std::sqrt(1 - z * z);
        const Vec3 d(float(r * std::cos(t)), float(r * std::sin(t)), float(z));
        const float row[4] = {float(4 * kPi / n), 1, .5f, 0};
        c.add(d, d, .02f, row);
    }
    for (const Vec3& at : {Vec3(0, 0, 0), Vec3(.5f, .2f, -.3f), Vec3(0, 0, .95f)}) {
        HemisphereQuery q;
        q.P = at;
        q.N = normalize(Vec3(1, 2, 3));
        const Seen s = look(c, q);
        EXPECT_NEAR(s.blocked, 1, .05);
        EXPECT_NEAR(s.light.x, s.blocked, 1e-4);
        EXPECT_NEAR(s.light.y, .5 * s.blocked, 1e-4);
        q.sides = DiskSides::Back;
        EXPECT_NEAR(look(c, q).blocked, 1, .05) << "seen from behind";
        q.sides = DiskSides::Front;
        EXPECT_LT(look(c, q).blocked, .1) << "harmonics of two bands leave a little";
        q.sides = DiskSides::Both;
        q.maxDistance = .01f;
        EXPECT_LT(look(c, q).blocked, .01);
    }
}

// More parts of clusters than a sorted lookup keeps (limits::kCloudFragments): neighbours become one, and what is near still
// hides what is behind. The part that is hidden is the form factor of a square, two of which look alike large here.
TEST(PointBased, SortedLookupsOfManyPointsAreBounded) {
    constexpr int kSide = 800;
    static_assert(size_t(2 * kSide * kSide) > limits::kCloudFragments);
    PointCloud c;
    addRectangle(c, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, kSide, Color(1, 0, 0));
    addRectangle(c, {0, 0, 2}, {16, 0, 0}, {0, -16, 0}, kSide, Color(0, 1, 0));
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.sort = true;
    q.maxSolidAngle = 1e-6f;
    const Seen seen = look(c, q);
    const double x = 8 / std::sqrt(65.), part = 2 / 3.14159265 * 2 * x * std::atan(x);
    EXPECT_NEAR(seen.blocked, part, .01);
    EXPECT_NEAR(seen.light.x, part, .03) << "toward the horizon a pixel holds many points of both";
    EXPECT_NEAR(seen.light.y, 0, .03);
}

// The same with many layers, each of which hides what is behind it: what lies behind the first three is seen nowhere, however
// many.
TEST(PointBased, SortedLookupsOfManyLayersShowTheFirst) {
    const auto shells = [](int count) {
        PointCloud c;
        c.channels = {{"_area", pointcloud::ChannelType::Float}, {"_radiosity", pointcloud::ChannelType::Color}};
        const int n = 14000;
        for (int k = 0; k < count; ++k)
            for (int i = 0; i < n; ++i) {
                const double z = 1 - (i + .5) / n, t = i * 2.399963229728653 + k, s = std::sqrt(1 - z * z);
                const Vec3 d(float(s * std::cos(t)), float(s * std::sin(t)), float(z));
                const float r = 1 + .1f * float(k), area = float(2 * kPi / n) * r * r;
                const float row[4] = {area, k == 0 ? 1.f : 0.f, 0, k == 0 ? 0.f : 1.f};
                c.add(d * r, -d, std::sqrt(area / 2), row);
            }
        return c;
    };
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.sort = true;
    q.maxSolidAngle = 1e-6f;
    const Seen few = look(shells(3), q), many = look(shells(40), q);
    EXPECT_NEAR(few.blocked, 1, .01);
    EXPECT_GT(few.light.x, .8);
    EXPECT_NEAR(many.blocked, 1, .01);
    EXPECT_NEAR(many.light.x, few.light.x, .02);
    EXPECT_NEAR(many.light.z, few.light.z, .02);
}

TEST(PointBased, ParametersDoWhatTheySay) {
    PointCloud c;
    addRectangle(c, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, 160, Color(1, 0, 0));
    addRectangle(c, {0, 0, 2}, {16, 0, 0}, {0, -16, 0}, 160, Color(0, 1, 0));
    HemisphereQuery q;
    q.N = {0, 0, 1};
    q.cone = .5f;
    const Seen together = look(c, q);
    EXPECT_NEAR(together.blocked, 1, 1e-4);
    q.sort = true;
    const Seen sorted = look(c, q);
    EXPECT_NEAR(sorted.light.x, 1, .1) << "what is near hides what is behind";
    EXPECT_NEAR(sorted.light.y, 0, .1);
    q.sort = false;
    q.clamp = false;
    EXPECT_NEAR(look(c, q).blocked, 2, .15);
    q.clamp = true;
    q.maxDistance = 1.8f;
    EXPECT_NEAR(look(c, q).light.x, 1, .05);
    q.maxDistance = 1e38f;
    q.bias = 1.2f;
    EXPECT_NEAR(look(c, q).light.y, 1, .06);
    // exp(-d / 2) over the cone of half angle .5 by the cosine, d = 1 / cos.
    PointCloud one;
    addRectangle(one, {0, 0, 1}, {8, 0, 0}, {0, -8, 0}, 160);
    q.bias = 0;
    q.fall = .5f;
    double sum = 0, weight = 0;
    for (int i = 0; i < 1000; ++i) {
        const double t = .5 * (i + .5) / 1000, w = std::sin(t) * std::cos(t);
        sum += w * std::exp(-.5 / std::cos(t)), weight += w;
    }
    EXPECT_NEAR(look(one, q).blocked, sum / weight, .02);
    q.fall = 0;
    q.cone = 1.57079633f;
    q.axis = {1, 0, 0};
    EXPECT_NEAR(look(one, q).blocked, look(one, HemisphereQuery{.N = {0, 0, 1}}).blocked, .02)
        << "half of it, which is like the other";
}

TEST(PointBased, WhatIsNoPoint) {
    EXPECT_TRUE(PointOctree(PointCloud{}, "").nodes().empty());
    PointCloud c = pointcloud::test::square(4);
    for (float& r : c.radius) r = 0;
    const PointOctree none(c, "c");
    EXPECT_EQ(none.leftOut(), 16u);
    EXPECT_TRUE(none.nodes().empty());
    PointCloud same; // all in one place: a leaf
    for (int i = 0; i < 1000; ++i) same.add({1, 2, 3}, {0, 0, 1}, .1f, {});
    const PointOctree o(same, "");
    EXPECT_EQ(o.points().size(), 1000u);
    EXPECT_LT(o.nodes().size(), 30u);
    EXPECT_LT(o.bytes(), 1000u * 100);
    same.P[3].x = NAN;
    EXPECT_EQ(PointOctree(same, "").leftOut(), 1u);
    same.radius[5] = 1e25f; // its area has no float
    const PointOctree left(same, "");
    EXPECT_EQ(left.leftOut(), 2u);
    EXPECT_TRUE(std::isfinite(left.nodes()[0].centre.x) && std::isfinite(left.nodes()[0].area));
    for (const Vec3& far :
         {Vec3(1e25f, 1e25f, 1e25f), Vec3(0, 0, 3e38f), Vec3(1e19f, 0, 2e19f)}) { // as one point, and as one of many
        HemisphereQuery q;
        q.N = {0, 0, 1};
        PointCloud one;
        one.add(far, {0, 0, -1}, .1f, {});
        EXPECT_EQ(look(one, q).blocked, 0);
        for (int i = 0; i < 100; ++i) one.add(far, {0, 0, -1}, 1e18f, {});
        const Seen s = look(one, q);
        EXPECT_TRUE(s.blocked >= 0 && s.blocked <= 1);
    }
}

} // namespace

} // namespace hemisphere_test

// Quadrics that sixteen rays come to: those that miss are left out by the same operations that meet the others.
#include "../geometry/make.h"
#include "accel/impl.h"
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace quadrics_test {

using namespace alpenglow;
using namespace alpenglow::accel;
using namespace alpenglow::geometry::test;

namespace {

using Rng = std::mt19937;
float uniform(Rng& r, float lo, float hi) { return lo + (hi - lo) * float(r() >> 8) * 0x1p-24f; }
Vec3 within(Rng& r, float size) { return {uniform(r, -size, size), uniform(r, -size, size), uniform(r, -size, size)}; }

struct Kind {
    const char* name;
    std::vector<float> numbers;
};

/// Rays of bundles, most of which pass close by the outline of what lies in `b`.
std::vector<Ray> raysAt(Rng& rng, const geometry::Bounds& b, float size) {
    const Vec3 middle = (b.lo + b.hi) * 0.5f, half = (b.hi - b.lo) * 0.5f;
    std::vector<Ray> rays;
    for (int bundle = 0; bundle < 60; ++bundle) {
        const Vec3 to = within(rng, 1), aim = middle + Vec3(to.x * half.x, to.y * half.y, to.z * half.z);
        for (int k = 0; k < 16; ++k) {
            Ray r;
            r.org = bundle % 8 ? Vec3(0.f) : middle + within(rng, 0.1f * size);
            r.dir = aim + within(rng, (bundle % 3 ? 0.02f : 0.3f) * size) - r.org;
            r.mask = kCamera;
            if (k == 3) r.tnear = 0.9f, r.tfar = 1.1f;
            rays.push_back(r);
        }
    }
    return rays;
}

/// Turned, scaled, mirrored, sheared, near and far; now and then in a perspective.
Matrix placeOf(Rng& rng, int scene, float size) {
    const Vec3 axis = within(rng, 1);
    Matrix m = rotateMatrix(37 * scene, axis.x, axis.y, axis.z) * scaleMatrix(size, scene % 4 ? size : -2 * size, size);
    if (scene % 5 == 0) m.m[0][1] += 0.3 * double(size);
    m = m * translateMatrix(0, 0, double(scene % 3 ? 3 * size : 300 * size));
    if (scene % 7 == 6) m.m[2][3] = 0.05 / double(size);
    return m;
}

} // namespace

TEST(Quadrics, AreMetTogetherAsAlone) {
    const std::vector<Kind> kinds = {{"Sphere", {1, -1, 1, 360}},
                                     {"Sphere", {1, -.5, .7, 250}},
                                     {"Sphere", {-1, -1, 1, 360}},
                                     {"Cylinder", {.7, -1, 1, 360}},
                                     {"Cone", {1.5, .8, 360}},
                                     {"Cone", {0, .8, 200}},
                                     {"Paraboloid", {1, .2, 1.5, 360}},
                                     {"Hyperboloid", {1, 0, -1, 0, 1, 1, 300}},
                                     {"Hyperboloid", {1, 0, .5, .4, 0, .5, 360}},
                                     {"Disk", {.3, 1, 360}},
                                     {"Torus", {1, .25, 0, 360, 360}},
                                     {"Torus", {1, 1e-4, 0, 360, 360}},
                                     {"Torus", {.4, .8, 0, 360, 300}},
                                     {"Torus", {1, -.3, 30, 200, 360}},
                                     {"Torus", {-1, .3, 0, 360, 360}}};
    Rng rng(5);
    size_t met = 0, missed = 0;
    for (const Kind& kind : kinds)
        for (int scene = 0; scene < 12; ++scene) {
            const float size = std::pow(10.f, uniform(rng, -2, 3));
            Diagnostics diag;
            Accel::Impl inside;
            inside.shapes = {build(quadric(kind.name, kind.numbers), placeOf(rng, scene, size), diag)};
            inside.visibility = {kAll};
            inside.readyForms();
            inside.tree.build(inside.shapes);
            const std::vector<Ray> rays = raysAt(rng, inside.shapes[0]->bounds(), size);
            std::vector<Hit> alone(rays.size());
            inside.walkNearest(rays, alone);
            for (const bool plain : {false, true}) {
                std::vector<Hit> together(rays.size());
                inside.walkNearestTogether(rays, together, plain);
                for (size_t i = 0; i < rays.size(); ++i) {
                    ASSERT_EQ(together[i].valid(), alone[i].valid()) << kind.name << " scene " << scene << " ray " << i;
                    (alone[i].valid() ? met : missed) += 1;
                    if (!alone[i].valid()) continue;
                    ASSERT_EQ(together[i].distance, alone[i].distance);
                    ASSERT_EQ(together[i].b1, alone[i].b1);
                    ASSERT_EQ(together[i].b2, alone[i].b2);
                }
            }
        }
    EXPECT_GT(met, 50000u);
    EXPECT_GT(missed, 50000u);
}

} // namespace quadrics_test

// T1 for what a camera ray draws: the point on the lens, the time in the shutter, the place in the pixel. With the film's own
// numbers, one sample of as many pixels. Power: alternating +-5 % over 200 cells is found at 1e5 draws.
#include "base/sampler.h"
#include "render/camera.h"
#include "scene/scene.h"
#include "statistics/agreement.h"
#include <gtest/gtest.h>

namespace camera_sampling_test {

using namespace alpenglow;
using namespace alpenglow::render;
using namespace alpenglow::teststat;

namespace {

int draws() { return samples(100'000, 1'000'000); }
Sampler stream(int i) { return Sampler(seedBase() + 1, i % 1000, i / 1000); }

} // namespace

TEST(CameraSampling, LensIsUniformOverItsDisc) {
    Diagnostics diagnostics;
    scene::Options o;
    o.projection = "perspective";
    o.fov = 40;
    o.fstop = 2;
    o.focalLength = 1; // radius 1/4
    o.focalDistance = 8;
    Camera camera(o, diagnostics);
    ASSERT_TRUE(camera.hasLens());
    const double radius = 0.25;
    std::vector<double> hits(200), expected(200, draws() / 200.0);
    for (int i = 0; i < draws(); ++i) {
        auto r = camera.ray(100, 77, stream(i).get2(0, 1, 0, uint32_t(i % 64)), 0);
        // Back to the lens, which lies at depth 0.
        Vec3 at = r.origin - r.direction * (r.origin.z / r.direction.z);
        double q = (double(at.x) * at.x + double(at.y) * at.y) / (radius * radius), phi = std::atan2(at.y, at.x) / (2 * kPi);
        ASSERT_LE(q, 1 + 1e-5);
        // Rings of equal area, and sectors.
        hits[size_t(std::clamp(int(q * 10), 0, 9) * 20 + std::clamp(int((phi < 0 ? phi + 1 : phi) * 20), 0, 19))]++;
    }
    EXPECT_GE(chiSquareP(hits, expected), kAlpha);
}
TEST(CameraSampling, TimeIsUniformInTheShutter) {
    Diagnostics diagnostics;
    scene::Options o;
    o.shutterOpen = 2;
    o.shutterClose = 5;
    Camera camera(o, diagnostics);
    std::vector<double> hits(200), expected(200, draws() / 200.0);
    for (int i = 0; i < draws(); ++i) {
        double t = camera.ray(3, 4, {0.5f, 0.5f}, stream(i).get1(0, 2, 0, uint32_t(i % 64))).time;
        ASSERT_GE(t, 2);
        ASSERT_LE(t, 5);
        hits[size_t(std::clamp(int((t - 2) / 3 * 200), 0, 199))]++;
    }
    EXPECT_GE(chiSquareP(hits, expected), kAlpha);
}
// Both numbers of a pair, at every sample number and replica: what a pixel filter, a lens or a lobe is given.
TEST(CameraSampling, PairsAreUniformAtEverySample) {
    for (uint32_t sample : {0u, 1u, 7u, 8u, 63u, 1000u}) {
        std::vector<double> hits(200), expected(200, draws() / 200.0);
        for (int i = 0; i < draws(); ++i) {
            Vec2 u = stream(i).get2(0, 3, 0, sample);
            hits[size_t(u.x * 10) * 20 + size_t(u.y * 20)]++;
        }
        EXPECT_GE(chiSquareP(hits, expected), kAlpha) << sample;
    }
}

} // namespace camera_sampling_test

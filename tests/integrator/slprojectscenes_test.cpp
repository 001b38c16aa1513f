// SLProject's four other ray-traced scenes in examples/slproject: their counts, and places whose colour the formulas of its
// classic ray tracer give (docs/design/slproject.md).
#include "integrator/floorscene.h"
#include <cmath>
#include <fstream>
#include <iterator>

namespace slprojectscenes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A scene of examples/slproject, by the classic ray tracer or by path.
Scene example(const std::string& name, bool path) {
    std::ifstream in(std::string(ALPENGLOW_SOURCE_DIR) + "/examples/slproject/" + name + ".rib");
    const std::string rib(std::istreambuf_iterator<char>(in), {});
    EXPECT_FALSE(rib.empty()) << name;
    return Scene(path ? "Option \"user\" \"string look\" [\"path\"]\n" + rib : rib,
                 withShaders(path ? Hider::Path : Hider::Raytrace));
}

/// The camera of a scene: Scale 1 1 -1, a turn about x, and the place of the eye.
struct View {
    double degrees;
    Vec3d eye;
    /// From the eye towards a point of the world.
    CameraRay towards(const Vec3d& world) const {
        const Vec3d p = world - eye;
        const double a = degrees * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
        return rayTo({0, 0, 0}, Vec3(Vec3d(p.x, c * p.y - s * p.z, -(s * p.y + c * p.z))));
    }
};

constexpr View kSpheres{2.29061, {0, .1, 2.5}}, kSoft{1.432096, {0, .1, 4}}, kDepth{15.9454, {0, 2, 7}}, kLens{90, {0, 8, 0}};

void expectNearly(const Color& c, const Vec3d& want, const char* what, double error = 1e-4) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], error) << what << " " << k;
}

/// Ambient light, both lamps and their highlights at a lit point of a floor (slclassic, shininess 100), cut at 1.
Vec3d litFloor(const Vec3d& at, const Vec3d& eye, double intensity, const Vec3d& albedo, double specular) {
    Vec3d sum = albedo * (2. / 12);
    for (const double z : {2., -2.}) {
        const Vec3d to = Vec3d(2, 2, z) - at, L = normalize(to), H = normalize(L + normalize(eye - at));
        const double light = intensity / dot(to, to);
        sum = sum + albedo * (light * L.y) + Vec3d(1, 1, 1) * (light * specular * std::pow(H.y, 100));
    }
    return {std::min(sum.x, 1.), std::min(sum.y, 1.), std::min(sum.z, 1.)};
}

} // namespace

TEST(SlProjectScenes, SpheresAreAFlakeOfDepthThree) {
    for (const bool path : {false, true}) {
        Scene s = example("spheres", path);
        EXPECT_EQ(s.world->facts().shapes, 1 + 9 + 81 + 729 + 1u);
        expectNearly(s.one(kSpheres.towards({0, 6, -3})), {.1, .4, .8}, "background");
        // The outermost of its balls, on the way to (0, .5 + 1/3 + 1/9 + 1/27, 0) none lies higher than the sum.
        expectNearly(s.one(kSpheres.towards({0, 1.05, 0})), {.1, .4, .8}, "above it");
    }
}

TEST(SlProjectScenes, SoftShadowsFallOnTheFloor) {
    Scene s = example("soft_shadows", false);
    EXPECT_EQ(s.world->facts().shapes, 1 + 9 + 1u);
    const Vec3d lit(3, -1, 0);
    expectNearly(s.one(kSoft.towards(lit)), litFloor(lit, kSoft.eye, 10, {.8, .6, .2}, .8), "lit by both");
    // The line from (-1, -1, -1) to the first lamp goes through the middle of the ball, so that none of its disk is seen; the
    // other lamp is 19 away, squared.
    const double other = 10 / 19. * 3 / std::sqrt(19.);
    expectNearly(s.one(kSoft.towards({-1, -1, -1})), {.8 * (2. / 12 + other), .6 * (2. / 12 + other), .2 * (2. / 12 + other)},
                 "lit by one", 2e-3);
    expectNearly(example("soft_shadows", true).one(kSoft.towards({0, 6, -3})), {.1, .4, .8}, "background");
}

TEST(SlProjectScenes, DepthOfFieldHasSevenBallsInFog) {
    for (const bool path : {false, true}) {
        Scene s = example("depth_of_field", path);
        EXPECT_EQ(s.world->facts().shapes, 7 + 64u);
        expectNearly(s.one(kDepth.towards({0, 9, -9})), {.5, .5, .5}, "background");
    }
    // Straight down from the eye: the sky is mirrored in the floor, 2 away, of a white square (x in [0, 10], z in [0, 10]).
    Scene s = example("depth_of_field", false);
    const Vec3d at(4, 0, 7);
    const double far = length(at - kDepth.eye), fog = std::exp(-.04 * far);
    const Color c = s.one(kDepth.towards(at));
    for (int k = 0; k < 3; ++k) {
        EXPECT_GT(c[k], .5 * (1 - fog) + fog * .8 * .2 - 1e-4) << "at least fog and ambient light";
        EXPECT_TRUE(std::isfinite(c[k]));
    }
}

// A thin lens of f = 15 (n = 1.5, both radii 15), 2 below the eye and 6 above the picture: what passes it at height h from its
// axis meets the picture at h + 6 (h / 2 - h / 15) = 3.6 h, and at 4 h without it.
TEST(SlProjectScenes, TheLensMagnifies) {
    Scene s = example("lens_test", false);
    const auto through = [&](double h) { return s.one(kLens.towards({h, 6, .13})).y; };
    const double inside = through(.26), beyond = through(.30); // .936 and 1.08: on either side of the edge at 1
    EXPECT_GT(std::fabs(inside - beyond), .4);
    EXPECT_NEAR(through(.20), inside, .1) << ".72: the same square";
    EXPECT_NEAR(through(.34), beyond, .1) << "1.22: the same square";
    EXPECT_LT(example("lens_test", true).one(kLens.towards({3, 0, 3})).y, 1.1f);
}

} // namespace slprojectscenes_test

// Russian roulette for light samples that bring little: fewer shadow rays, the same mean, and nothing where a shader makes more
// of a sum of light than adding it.
#include "integrator/floorscene.h"
#include "world/photonstore.h"

namespace shadowroulette_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {
/// A floor between two walls under three lamps and a sky: 2 + 2 cos of light at the zenith.
const std::string kRoom =
    "LightSource \"twilight\" 1\n"
    "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 2 Surface \"constant\" Color 0 0 0 "
    "Polygon \"P\" [-1 2 -1  1 2 -1  1 2 1  -1 2 1] AttributeEnd\n"
    "LightSource \"pointlight\" 3 \"float intensity\" .5 \"point from\" [0 1 1]\n"
    "LightSource \"distantlight\" 4 \"float intensity\" .1 \"point from\" [0 1 0] \"point to\" [0 0 0]\n"
    "Illuminate 1 1 Surface \"slmaterial\" \"color diffusecolor\" [.8 .6 .4]\n"
    "Polygon \"P\" [-2 0 -9  -2 0 9  -2 4 9  -2 4 -9] Polygon \"P\" [2 0 -9  2 0 9  2 4 9  2 4 -9]\n";

Scene room(const std::string& floor) {
    writeShader("twilight", "light twilight() { solar() Cl = 2 + 2 * ycomp(vtransform(\"world\", -normalize(L))); }\n");
    return Scene(inWorld(kRoom + floor + kFloor), withShaders(Hider::Path));
}
} // namespace

TEST(ShadowRoulette, KeepsTheMean) {
    Scene s = room("");
    const CameraRay ray = rayTo({.4f, .5f, -.3f}, {.2f, 0, .1f});
    const int n = samples(20000);
    Counters before, after;
    const Moments all = s.estimate(ray, n, &before);
    ASSERT_NE(s.world->photons(), nullptr);
    s.world->photons()->leastLight = 3 * float(all.mean()); // about all rays are below this
    const Moments some = s.estimate(ray, n, &after);
    EXPECT_LT(double(after.shadow), .6 * double(before.shadow));
    EXPECT_GT(double(after.shadow), .09 * double(before.shadow)); // the least probability is .1
    for (int k = 0; k < 3; ++k) {
        const double se = std::hypot(all.se(k), some.se(k));
        EXPECT_NEAR(some.mean(k), all.mean(k), kZ * se) << k;
        EXPECT_LT(se, .02 * all.mean(k)) << k << ": not precise enough to decide";
    }
    s.world->photons()->leastLight = 1e-12f;
    EXPECT_EQ(s.estimate(ray, 500).mean(), s.estimate(ray, 500).mean());
}

// The square of a sum of light would be larger in the mean.
TEST(ShadowRoulette, LeavesLightThatAShaderWaitsFor) {
    writeShader("squared",
                "surface squared() { color c = trace(P, vector(0, 1, 0)) + diffuse(normalize(N)); Oi = 1; Ci = c * c; }\n");
    Scene s = room("Surface \"squared\"\n");
    const CameraRay ray = rayTo({.4f, .5f, -.3f}, {.2f, 0, .1f});
    Counters before, after;
    const Moments all = s.estimate(ray, 400, &before);
    s.world->photons()->leastLight = 1e6f;
    const Moments same = s.estimate(ray, 400, &after);
    EXPECT_GT(all.mean(), 0);
    EXPECT_EQ(all.mean(), same.mean());
    EXPECT_EQ(before.shadow, after.shadow);
}

} // namespace shadowroulette_test

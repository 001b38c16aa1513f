// The last vertex that a depth allows: lamps are sampled there, and skies and ambient light count as well, though no ray goes on.
#include "integrator/floorscene.h"

namespace lastskies_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {
Settings depth(int most) {
    Settings s = withShaders(Hider::Path);
    s.maxDepth = most;
    return s;
}
const std::string kLambert = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n";
/// A black disc over the origin that takes r^2 / (r^2 + h^2) of a sky from the floor; of opacity .5 half of that.
std::string disc(const char* opacity) {
    return std::string("AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nOpacity ") + opacity + " " + opacity + " " + opacity +
           "\nTranslate 0 1 0\nRotate -90 1 0 0\nDisk 0 1 360\nAttributeEnd\n";
}
const CameraRay kFlat = rayTo({2.5f, .4f, -.4f}, {0, 0, 0}); ///< beside the disc
} // namespace

TEST(LastSkies, AtEveryDepth) {
    const std::string sky = "LightSource \"envlight\" 1 \"float intensity\" 2\n";
    for (const int most : {0, 1, 4}) {
        const Moments m = Scene(inWorld(sky + kLambert + kFloor), depth(most)).estimate(kView, 500);
        EXPECT_NEAR(m.mean(), 2, 1e-4) << most;
        // What the disc sends back is black: the same light at any depth.
        const Moments half = Scene(inWorld(sky + disc("1") + kLambert + kFloor), depth(most)).estimate(kFlat, samples(8000));
        EXPECT_NEAR(half.mean(), 1, kZ * half.se()) << most;
        EXPECT_LE(half.se(), .02);
        const Moments thin = Scene(inWorld(sky + disc(".5") + kLambert + kFloor), depth(most)).estimate(kFlat, samples(8000));
        EXPECT_NEAR(thin.mean(), 1.5, kZ * thin.se()) << most;
    }
}

// Over the floor's point a half ball that is open about the axis: the point sees the sky within the cosine .8, the part .36 of
// what lights it. Both send half of their light back; another bounce brings more, and never more than a furnace has.
TEST(LastSkies, EachBounceOnce) {
    const std::string sky = "LightSource \"envlight\" 1 \"float intensity\" 1\n",
                      half = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" .5\n";
    const std::string cup = "AttributeBegin\n" + half + "Rotate -90 1 0 0\nSphere 1 0 .8 360\nAttributeEnd\n";
    const CameraRay view = rayTo({.05f, 1.6f, .02f}, {0, 0, 0});
    const Moments first = Scene(inWorld(sky + cup + half + kFloor), depth(0)).estimate(view, samples(60'000)),
                  second = Scene(inWorld(sky + cup + half + kFloor), depth(1)).estimate(view, samples(60'000));
    EXPECT_NEAR(first.mean(), .5 * .36, kZ * first.se());
    EXPECT_LE(first.se(), .01);
    EXPECT_GT(second.mean(), first.mean() + kZ * (first.se() + second.se()));
    EXPECT_LT(second.mean(), .5);
}

TEST(LastSkies, AmbientLightAndTrace) {
    Scene ambient(inWorld(std::string("LightSource \"ambientlight\" 1 \"float intensity\" .75\nSurface \"matte\"\n") + kFloor),
                  depth(0));
    EXPECT_NEAR(ambient.estimate(kView, 200).mean(), .75, 1e-4);
    writeShader("lasttrace",
                "surface lasttrace(float lights = 0;) { normal n = normalize(faceforward(N, I)); Oi = 1; Ci = trace(P, "
                "vector(n), \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samplearealights\", lights); }\n");
    const std::string sky = "LightSource \"envlight\" 1 \"float intensity\" 2\n";
    // As lamps are: where lights are asked for.
    EXPECT_NEAR(Scene(inWorld(sky + "Surface \"lasttrace\" \"float lights\" 1\n" + kFloor), depth(0)).estimate(kView, 200).mean(),
                2, 1e-4);
    EXPECT_EQ(Scene(inWorld(sky + "Surface \"lasttrace\"\n" + kFloor), depth(0)).estimate(kView, 200).mean(), 0);
    // A sky that only loops over lights see is none for rays of trace(), at any depth.
    const std::string loops = "Attribute \"light\" \"string samplingstrategy\" \"illuminance\"\n";
    for (const int most : {0, 1})
        EXPECT_EQ(Scene(inWorld(loops + sky + "Surface \"lasttrace\" \"float lights\" 1\n" + kFloor), depth(most))
                      .estimate(kView, 200)
                      .mean(),
                  0)
            << most;
    // A sky that is off brings nothing.
    EXPECT_EQ(Scene(inWorld(sky + "Illuminate 1 0\n" + kLambert + kFloor), depth(0)).estimate(kView, 200).mean(), 0);
}

} // namespace lastskies_test

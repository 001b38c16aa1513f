// What trace() finds of area lights and of its map as if nothing else were there: also of mirror rays, and of rays that begin
// beside the surface. A floor under a disc of radius .8 at height 2 that shines, behind a card.
#include "integrator/floorscene.h"
#include "integrator/maps.h"

namespace unshadowed_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kLamp = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"light\" \"string units\" "
                          "\"radiance\"\nSurface \"constant\"\nColor 0 0 0\nAreaLightSource \"unlamp\" 1\nTranslate 0 2 0\n"
                          "Rotate -90 1 0 0\nDisk 0 .8 360\nAttributeEnd\nIlluminate 1 1\n",
                  kCard = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"constant\"\nColor .5 .5 .5\nPolygon "
                          "\"P\" [-9 1 -9  9 1 -9  9 1 9  -9 1 9]\nAttributeEnd\n";
const CameraRay kBelow = rayTo({.3f, .4f, -.4f}, {0, 0, 0});

/// The mean of an output of trace(from, straight up, more).
Moments arriving(const std::string& what, const std::string& from, const std::string& more, const std::string& others, Hider h,
                 int n) {
    static int number = 0;
    writeShader("unlamp", "light unlamp() { illuminate(P, N, PI) Cl = 5; }\n");
    const std::string name = "untold" + std::to_string(number++), map = writeMap("unmap.exr", 4, 2, Color(1));
    writeShader(name, "surface " + name + "() { vector up = vector \"world\" (0, 1, 0); color v = 0; color c = trace(" + from +
                          ", up, \"samplearealights\", 1, \"environmentmap\", " + map + more + ", \"" + what +
                          "\", v); Oi = 1; Ci = v; }\n");
    return Scene(inWorld(kLamp + others + "Surface \"" + name + "\"\n" + kFloor), withShaders(h)).estimate(kBelow, n);
}
const std::string kCosine = ", \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"type\", \"diffuse\"";
constexpr double kPart = .8 * .8 / (.8 * .8 + 4); ///< of the hemisphere that the disc takes

} // namespace

TEST(Unshadowed, AreaLightsOfMirrorRays) {
    for (const Hider h : {Hider::Path, Hider::Raytrace}) {
        EXPECT_NEAR(arriving("unshadowedarealight", "P", "", "", h, 4).mean(), 5, 1e-5);
        EXPECT_NEAR(arriving("unshadowedarealight", "P", "", kCard, h, 4).mean(), 5, 1e-5);
        EXPECT_NEAR(arriving("unshadowedarealight", "P + vector \"world\" (.7, 0, 0)", "", kCard, h, 4).mean(), 5, 1e-5);
        EXPECT_EQ(arriving("unshadowedarealight", "P + vector \"world\" (.9, 0, 0)", "", kCard, h, 4).mean(), 0);
    }
}

TEST(Unshadowed, AreaLightsOfRaysFromElsewhere) {
    for (const Hider h : {Hider::Path, Hider::Raytrace})
        for (const std::string& card : {std::string(), kCard}) {
            const double up = .64 / (.64 + 1.5 * 1.5); // half a unit above the floor
            const Moments m = arriving("unshadowedarealight", "P + vector \"world\" (0, .5, 0)", kCosine, card, h, samples(8000));
            EXPECT_NEAR(m.mean(), 5 * up, kZ * m.se());
            EXPECT_LE(m.se(), .2 * up);
            const Moments here = arriving("unshadowedarealight", "P", kCosine, card, h, samples(8000));
            EXPECT_NEAR(here.mean(), 5 * kPart, kZ * here.se());
        }
}

TEST(Unshadowed, AreaLightsBlockTheMap) {
    for (const Hider h : {Hider::Path, Hider::Raytrace})
        for (const std::string& card : {std::string(), kCard}) {
            EXPECT_EQ(arriving("unshadowedenvironment", "P", "", card, h, 4).mean(), 0);
            EXPECT_NEAR(arriving("unshadowedenvironment", "P + vector \"world\" (.9, 0, 0)", "", card, h, 4).mean(), 1, 1e-4);
            const Moments m = arriving("unshadowedenvironment", "P", kCosine, card, h, samples(8000));
            EXPECT_NEAR(m.mean(), 1 - kPart, kZ * m.se());
            EXPECT_LE(m.se(), .02);
        }
}

} // namespace unshadowed_test

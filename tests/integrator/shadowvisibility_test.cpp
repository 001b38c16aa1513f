// Surfaces that shadow rays and rays of lobes see differently: lights that are sampled arrive as shadow rays have it, all of them
// and once, whatever the rays of the lobe meet.
#include "integrator/floorscene.h"

namespace shadowvisibility_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// A square lamp of radiance 1 and half size 1 at height 1, above the origin.
const std::string kLamp = "AttributeBegin Sides 1 AreaLightSource \"slrect\" 1 \"float intensity\" 1 Surface \"constant\" "
                          "Color 0 0 0 Polygon \"P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 1] AttributeEnd Illuminate 1 1\n";
/// A sky that is brightest above, 5 cos^8 of the angle from there, which is sampled: its light on a level floor is 5 2/10 pi.
const std::string kSky = "LightSource \"zenith\" 1\n";
/// The factor by which a square of half size 1 at distance 1 lights the point below its middle: 4 corners of 1 x 1, each
/// 1/pi (1/sqrt 2) atan(1/sqrt 2) (Howell's catalog of configuration factors, B-4).
const double kFactor = 4 / kPi * std::sqrt(.5) * std::atan(std::sqrt(.5));

std::string card(const std::string& attributes, const std::string& surface = "Surface \"constant\" Color 0 0 0") {
    return "AttributeBegin " + attributes + surface +
           " Polygon \"P\" [-60 .5 -60  -60 .5 60  60 .5 60  60 .5 -60] AttributeEnd\n";
}

/// `part` of the light that arrives without `before` arrives behind it, on a diffuse floor and on a glossy one. Without it, a
/// diffuse floor sends `open` times its reflectance. 3e-4: at the horizon a card leaves .5 / 60 of the angle open.
void expectLight(const std::string& light, const std::string& before, double part, double open, const std::string& what) {
    for (const bool diffuse : {true, false}) {
        const std::string floor =
            (diffuse ? "Surface \"slmaterial\" \"color diffusecolor\" [.5 .5 .5]\n" : "Surface \"rough\"\n") +
            std::string(kFloor);
        const CameraRay ray = rayTo({.2f, .3f, -.1f}, {0, 0, 0});
        Scene with(inWorld(light + before + floor), withShaders(Hider::Path)),
            without(inWorld(light + floor), withShaders(Hider::Path));
        const Moments m = with.estimate(ray, samples(6000)), clear = without.estimate(ray, samples(6000));
        if (diffuse) EXPECT_NEAR(clear.mean(), .5 * open, kZ * clear.se() + 1e-3 * open) << what;
        EXPECT_NEAR(m.mean(), part * clear.mean(), kZ * std::hypot(m.se(), part * clear.se()) + 3e-4)
            << what << diffuse << with.messages();
        EXPECT_LT(m.se(), .02 * clear.mean()) << what << diffuse << ": not precise enough to decide";
    }
}

} // namespace

TEST(ShadowVisibility, LightArrivesAsShadowRaysHaveIt) {
    writeShader("rough",
                "surface rough() { normal n = normalize(N); Oi = 1; Ci = trace(P, n, \"distribution\", \"cook-torrance\", "
                "\"roughness\", .4, \"samplearealights\", 1, \"type\", \"specular\"); }\n");
    writeShader("zenith", "light zenith() { solar() Cl = 5 * pow(max(0, ycomp(vtransform(\"world\", -normalize(L)))), 8); }\n");
    writeShader("halfshadow", "surface halfshadow() { Ci = 0; Oi = isshadowray() ? color .25 : color 1; }\n");
    writeShader("clearelse", "surface clearelse() { Ci = 0; Oi = isshadowray() ? color 1 : color .5; }\n");
    for (const auto& [light, open] : {std::pair{kLamp, kFactor}, std::pair{kSky, 1.}}) {
        const std::string of = light == kSky ? "sky: " : "lamp: ";
        expectLight(light, card("Attribute \"visibility\" \"int transmission\" 0 "), 1, open, of + "shadow rays pass it");
        expectLight(light, card("Attribute \"visibility\" \"int diffuse\" 0 \"int specular\" 0 "), 0, open, of + "lobes pass it");
        expectLight(light, card("", "Surface \"halfshadow\""), .75, open, of + "a shader lets shadow rays pass in part");
        expectLight(light, card("", "Surface \"clearelse\""), 0, open, of + "a shader lets rays of lobes pass in part");
        expectLight(light,
                    card("Attribute \"shade\" \"string transmissionhitmode\" \"primitive\" Opacity .25 .25 .25 ",
                         "Surface \"constant\" Color 0 0 0"),
                    .75, open, of + "shadows by Opacity");
    }
}

// What the camera saw on its way to the floor is not between the floor and the lamp: the floor sends the same to both sides, and
// the veil takes half of what goes through it.
TEST(ShadowVisibility, SurfacesBeforeTheFloorAreNotBetween) {
    writeShader("veil", "surface veil() { Ci = 0; Oi = isshadowray() ? color 1 : color .5; }\n");
    Scene s(inWorld(kLamp +
                    "AttributeBegin Surface \"veil\" Polygon \"P\" [.05 .1 -.1  .15 .1 -.1  .15 .1 .1  .05 .1 .1] "
                    "AttributeEnd Surface \"slmaterial\" \"color diffusecolor\" [.5 .5 .5]\n" +
                    kFloor),
            withShaders(Hider::Path));
    const Moments behind = s.estimate(rayTo({.3f, .3f, 0}, {0, 0, 0}), samples(6000)),
                  clear = s.estimate(rayTo({-.3f, .3f, 0}, {0, 0, 0}), samples(6000));
    EXPECT_NEAR(behind.mean(), .5 * clear.mean(), kZ * std::hypot(behind.se(), .5 * clear.se()));
    EXPECT_LT(behind.se(), .02 * behind.mean()) << "not precise enough to decide";
}

// A lamp that shadow rays pass itself is no surface between.
TEST(ShadowVisibility, TheLampItselfIsNotBetween) {
    const std::string lamp =
        "AttributeBegin Attribute \"visibility\" \"int transmission\" 0 " + kLamp.substr(kLamp.find("Sides"));
    expectLight(lamp, "", 1, kFactor, "lamp without shadows");
}

// A ball of fog below the card, thin and thick: its light is estimated by samples of lights at distances chosen for the medium,
// at distances chosen for the light, and by rays of the phase function.
TEST(ShadowVisibility, MediaGetLightAsShadowRaysHaveIt) {
    writeShader("clearelse", "surface clearelse() { Ci = 0; Oi = isshadowray() ? color 1 : color .5; }\n");
    writeShader("halfshadow", "surface halfshadow() { Ci = 0; Oi = isshadowray() ? color .25 : color 1; }\n");
    writeShader("zenith", "light zenith() { solar() Cl = 5 * pow(max(0, ycomp(vtransform(\"world\", -normalize(L)))), 8); }\n");
    for (const char* sigma : {"1", "20"}) {
        const std::string fog = "AttributeBegin Surface \"null\" Interior \"medium\" \"color scattering\" [" +
                                std::string(sigma) + " " + sigma + " " + sigma +
                                "] Translate 0 -.3 0 Sphere .25 -.25 .25 360 AttributeEnd\n";
        for (const std::string& light : {kLamp, kSky})
            for (const auto& [before, part] :
                 {std::pair{card("Attribute \"visibility\" \"int transmission\" 0 "), 1.},
                  std::pair{card("Attribute \"visibility\" \"int diffuse\" 0 \"int specular\" 0 "), 0.},
                  std::pair{card("", "Surface \"clearelse\""), 0.}, std::pair{card("", "Surface \"halfshadow\""), .75}}) {
                Scene with(inWorld(light + before + fog), withShaders(Hider::Path)),
                    without(inWorld(light + fog), withShaders(Hider::Path));
                const CameraRay ray =
                    rayTo({.2f, .3f, -.1f}, {0, -.3f, 0}); // the fog does not contain the origin of camera space
                const Moments m = with.estimate(ray, samples(6000)), clear = without.estimate(ray, samples(6000));
                const std::string what = std::string(sigma) + (light == kSky ? " sky " : " lamp ") + before;
                EXPECT_NEAR(m.mean(), part * clear.mean(), kZ * std::hypot(m.se(), part * clear.se()) + 3e-4) << what;
                EXPECT_LT(m.se(), .03 * clear.mean()) << what << ": not precise enough to decide";
            }
    }
}

} // namespace shadowvisibility_test

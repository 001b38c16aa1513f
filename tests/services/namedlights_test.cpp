// Lights that published RIB files name: windowlight, indirect, causticlight.
#include "integrator/floorscene.h"

namespace publishedlights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kMatte = "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1\n";

TEST(PublishedLights, WindowWithCrossbars) {
    // A window at height 4 that looks down, two panes by three, 2 wide and 1 deep, bars a fifth of a pane, sharp edges.
    const std::string window =
        "LightSource \"windowlight\" 1 \"float intensity\" 2 \"color lightcolor\" [.5 .25 .125] \"color darkcolor\" [.01 .02 "
        ".03] "
        "\"point from\" [0 1 0] \"point to\" [0 0 0] \"point center\" [0 4 0] \"vector in\" [0 -1 0] \"vector up\" [0 0 1] "
        "\"float panewidth\" 2 \"float paneheight\" 1 \"float framewidth\" .2 \"float frameheight\" .2 \"float fuzz\" 0.01\n";
    // A wall above the window casts no shadow through it. It is black: nothing comes back from it under path.
    const std::string above =
        "AttributeBegin Surface \"matte\" Color 0 0 0 Polygon \"P\" [-9 5 -9  -9 5 9  9 5 9  9 5 -9] AttributeEnd\n";
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s(inWorld(window + kMatte + kFloor + above), withShaders(h));
        const auto at = [&](float x, float z) { return s.one(rayTo({x + .1f, 1, z - .1f}, {x, 0, z})); };
        const Color light(1, .5f, .25f), dark(.02f, .04f, .06f);
        const std::pair<Vec2, Color> places[] = {{{1, 0}, light},    {{-1, 0}, light},   {{1, 1}, light},    {{-1, -1}, light},
                                                 {{0, 0}, dark},     {{.15f, 0}, dark},  {{.25f, 0}, light}, {{1, .5f}, dark},
                                                 {{1, .38f}, light}, {{1, 1.45f}, dark}, {{3, 0}, dark},     {{1, 1.7f}, dark},
                                                 {{-1.9f, 0}, dark}};
        for (const auto& [p, want] : places)
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(at(p.x, p.y)[k], want[k], 1e-4) << p.x << " " << p.y << ", hider " << int(h);
    }
    // It falls into the room only: a surface behind the wall has none of it.
    Scene behind(
        inWorld(window +
                "Surface \"matte\" \"float Ka\" 0 \"float Kd\" 1 Polygon \"P\" [-60 6 -60  -60 6 60  60 6 60  60 6 -60]\n"),
        withShaders(Hider::Hidden));
    EXPECT_EQ(behind.one(rayTo({1.1f, 5, .1f}, {1, 6, 0})).x, 0);
}

TEST(PublishedLights, IndirectLight) {
    // Inside a ball that sends 1/4 from everywhere the floor gets that, and nothing from a light of that name under path, which
    // finds it alone.
    const std::string ball = "AttributeBegin Surface \"constant\" Color .25 .25 .25 Sphere 40 -40 40 360 AttributeEnd\n";
    const std::string begin = "Option \"trace\" \"integer maxdepth\" 1\n",
                      light = "LightSource \"indirect\" 1 \"float samples\" 16 \"color filter\" [1 .5 2]\n";
    Scene s(begin + inWorld(light + kMatte + kFloor + ball), withShaders(Hider::Raytrace));
    const Color c = s.one(kView);
    EXPECT_NEAR(c.x, .25, 1e-4);
    EXPECT_NEAR(c.y, .125, 1e-4);
    EXPECT_NEAR(c.z, .5, 1e-4);
    // Half of the sky, as seen by the cosine: a wall from the horizon to the zenith's plane halves it.
    const std::string wall = "AttributeBegin Surface \"constant\" Color 1 1 1 Polygon \"P\" [1e-3 -1e5 -1e5  1e-3 -1e5 1e5  1e-3 "
                             "1e5 1e5  1e-3 1e5 -1e5] AttributeEnd\n";
    Scene half(begin + inWorld("LightSource \"indirect\" 1 \"float samples\" 4\n" + kMatte + kFloor + wall),
               withShaders(Hider::Raytrace));
    expectMean(half.estimate(rayTo({-.3f, .8f, -.4f}, {0, 0, 0}), samples(2000)), .5, .05, "half");
    Scene path(inWorld(light + kMatte + kFloor), withShaders(Hider::Path));
    EXPECT_EQ(maxComponent(path.one(kView)), 0);
    // Highlights have none of it.
    Scene metal(begin + inWorld(light + "Surface \"metal\" \"float Ka\" 0 \"float Ks\" 1\n" + kFloor + ball),
                withShaders(Hider::Raytrace));
    EXPECT_EQ(maxComponent(metal.one(kView)), 0);
}

TEST(PublishedLights, CausticsWithoutAMapAreNone) {
    Scene s(inWorld("LightSource \"causticlight\" 1 \"color filter\" [1 .5 .25]\n" + kMatte + kFloor),
            withShaders(Hider::Hidden));
    EXPECT_EQ(maxComponent(s.one(kView)), 0);
    EXPECT_EQ(s.messages(), ""); // a surface that names no map has none
}

} // namespace

} // namespace publishedlights_test

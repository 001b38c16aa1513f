// Who is visible to traced rays under the older hiders: what the scene says; all where it says nothing, as in BMRT's time.
#include "integrator/harness.h"

namespace oldvisibility_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

TEST(OldVisibility, ScenesThatSayNothingMeanEverything) {
    writeShader("upwards", "surface upwards() { Oi = 1; Ci = trace(P, vector(0, 1, 0)); }\n");
    const std::string floor = "AttributeBegin Surface \"upwards\" Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9] AttributeEnd\n";
    const std::string card = "Surface \"constant\" Color .5 .25 1 Polygon \"P\" [-9 2 -9  -9 2 9  9 2 9  9 2 -9]\n";
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Settings s;
        s.hider = h;
        s.shaderPaths.push_back(shaderFolder());
        const bool path = h == Hider::Path;
        const struct {
            std::string first, ofCard;
            bool seen;
        } cases[] = {
            {"", "", true},
            {"", "Attribute \"visibility\" \"int transmission\" 1\n", true}, // says nothing on reflections
            {"", "Attribute \"visibility\" \"int trace\" 1\n", true},
            {"", "Attribute \"visibility\" \"int specular\" 0\n", false},
            {"AttributeBegin Attribute \"visibility\" \"int trace\" 1 Translate 0 -90 0 Sphere 1 -1 1 360 AttributeEnd\n", "",
             path}};
        for (const auto& c : cases) {
            Scene scene("WorldBegin\n" + c.first + floor + "AttributeBegin\n" + c.ofCard + card + "AttributeEnd\nWorldEnd\n", s);
            const Color seen = scene.one(rayTo({.3f, 1, -.4f}, {0, 0, 0}));
            EXPECT_NEAR(seen.x, c.seen ? .5 : 0, 1e-6) << int(h) << c.first << c.ofCard << scene.messages();
            EXPECT_NEAR(seen.z, c.seen ? 1 : 0, 1e-6) << int(h) << c.first << c.ofCard;
        }
    }
}

// 1 for the camera, 2 for reflections, 4 for shadows.
TEST(OldVisibility, BmrtsFlags) {
    writeShader("threeways", "surface threeways() { Oi = 1; color there = trace(P, vector(0, 1, 0));"
                             " Ci = color(comp(there, 0), comp(transmission(P, P + vector(0, 9, 0)), 0), 0); }\n");
    const std::string floor =
        "AttributeBegin Surface \"threeways\" Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9] AttributeEnd\n";
    const std::string card = "Surface \"constant\" Color 1 1 1 Polygon \"P\" [-9 2 -9  -9 2 9  9 2 9  9 2 -9]\n";
    Settings s;
    s.hider = Hider::Hidden;
    s.shaderPaths.push_back(shaderFolder());
    for (int flags = 0; flags < 8; ++flags) {
        Scene scene("WorldBegin\n" + floor + "AttributeBegin Attribute \"render\" \"integer visibility\" [" +
                        std::to_string(flags) + "]\n" + card + "AttributeEnd\nWorldEnd\n",
                    s);
        const Color fromBelow = scene.one(rayTo({.3f, 1, -.4f}, {0, 0, 0})),
                    fromAbove = scene.one(rayTo({.3f, 4, -.4f}, {0, 0, 0}));
        EXPECT_NEAR(fromBelow.x, flags & 2 ? 1 : 0, 1e-6) << flags << scene.messages();
        EXPECT_NEAR(fromBelow.y, flags & 4 ? 0 : 1, 1e-6) << flags;
        EXPECT_NEAR(fromAbove.z, flags & 1 ? 1 : 0, 1e-6) << flags; // the card itself, or the floor through it
    }
}

// A scene that says of some primitives that they cast shadows means that the others cast none. One that only takes some out does
// not.
TEST(OldVisibility, ShadowsOfWhatSaysSo) {
    writeShader("upto", "surface upto() { Oi = 1; Ci = transmission(P, P + vector(0, 9, 0)); }\n");
    const std::string floor = "AttributeBegin Surface \"upto\" Polygon \"P\" [-9 0 -9  -9 0 9  9 0 9  9 0 -9] AttributeEnd\n";
    const auto card = [](const std::string& says, const char* at) {
        return "AttributeBegin\n" + (says.empty() ? "" : "Attribute \"visibility\" " + says + "\n") +
               "Surface \"constant\" Translate " + at + "  Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\nAttributeEnd\n";
    };
    const struct {
        const char *near, *far; // of a card above the point, and of one elsewhere
        bool shadow;
    } cases[] = {{"", "", true},
                 {"", "\"int transmission\" 0", true},
                 {"", "\"string transmission\" \"transparent\"", true},
                 {"", "\"int transmission\" 1", false},
                 {"", "\"string transmission\" \"opaque\"", false},
                 {"\"int transmission\" 1", "", true},
                 {"\"int transmission\" 0", "", false}};
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Settings s;
        s.hider = h;
        s.shaderPaths.push_back(shaderFolder());
        for (const auto& c : cases) {
            Scene scene("WorldBegin\n" + floor + card(c.near, "0 2 0") + card(c.far, "90 2 0") + "WorldEnd\n", s);
            const bool shadow = c.shadow || (h == Hider::Path && !*c.near); // all of path's unset visibilities are 1
            EXPECT_NEAR(scene.one(rayTo({.3f, 1, -.4f}, {0, 0, 0})).x, shadow ? 0 : 1, 1e-6) << int(h) << c.near << c.far;
        }
    }
}

} // namespace oldvisibility_test

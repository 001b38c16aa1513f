// What lights of old files say: Cl before, in and behind a block, and shadows that an attribute asks for. A floor y = 0 seen at
// the origin.
#include "integrator/harness.h"

namespace oldlights_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kFloor =
    "AttributeBegin\nSurface \"matte\" \"Ka\" 1 \"Kd\" 1\nPolygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\nAttributeEnd\n";
const CameraRay kView = rayTo({.3f, .8f, -.4f}, {0, 0, 0});

Settings under(Hider h) {
    Settings s;
    s.hider = h;
    return s;
}

// The light stands 2 above the floor: L.N = 1. An ambient light would be seen at hidden, and would be the sky of path.
TEST(OldLights, ClAroundABlock) {
    const struct {
        const char* name;
        const char* body;
        float want;
    } cases[] = {
        {"clbefore", "Cl = .5; illuminate(q) { Cl *= 2; }", 1},
        {"clbehind", "illuminate(q) { Cl = 3; } Cl *= .5;", 1.5f},
        {"claround", "Cl = .25; illuminate(q) Cl += .5; Cl *= color(2, 2, 2);", 1.5f},
        {"clunset", "Cl = .75; illuminate(q) { }", .75f},
        {"clcone", "Cl = .5; illuminate(q, vector \"world\" (0, 1, 0), .1) { Cl = 1; }", 0}, // looks away: not even ambient
        {"clconelater", "illuminate(q, vector \"world\" (0, 1, 0), .1) { Cl = 1; } Cl += .5;",
         0}, // a light with a block is not ambient
        {"clsolar", "solar(vector \"world\" (0, -1, 0), 0) Cl = 2; Cl *= .25;", .5f},
        {"cltwo", "Cl = 1; illuminate(q) Cl *= 2; illuminate(q) Cl *= 3;", 5},     // two lights, each from the same start
        {"clnone", "if (1 == 0) { illuminate(q) Cl = 8; } else Cl = .25;", .25f}}; // no block runs: ambient
    for (const auto& c : cases) {
        writeShader(c.name, std::string("light ") + c.name + "() { point q = point \"world\" (0, 2, 0); " + c.body + " }\n");
        Scene s("WorldBegin\nSides 2\nLightSource \"" + std::string(c.name) + "\" 1\n" + kFloor + "WorldEnd\n",
                under(Hider::Hidden));
        EXPECT_NEAR(s.one(kView).x, c.want, 1e-5) << c.body << s.messages();
        EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    }
}

// P of a light without area is its own place, 5 aside; for Pixie's shaders it is the point being lit, as Ps is.
TEST(OldLights, ThePointOfALight) {
    writeShader("ownpoint", "light ownpoint(point from = point \"world\" (0, 2, 0);) { illuminate(from) Cl = 1 + "
                            "xcomp(transform(\"world\", P)) + 8 * distance(Ps, P); }\n");
    for (const bool pixie : {false, true}) {
        Settings settings = under(Hider::Hidden);
        if (pixie) settings.dialect = "pixie";
        Scene s("WorldBegin\nSides 2\nTransformBegin\nTranslate 5 0 0\nLightSource \"ownpoint\" 1\nTransformEnd\n" +
                    std::string(kFloor) + "WorldEnd\n",
                settings);
        EXPECT_NEAR(s.one(kView).x, pixie ? 1 : 46, 1e-4);
        EXPECT_EQ(s.diagnostics.warnings(), pixie ? 0 : 1) << s.messages();
        EXPECT_EQ(s.messages().find("P is the position of the light") != std::string::npos, !pixie) << s.messages();
    }
}

// A pane of opacity .25 a unit above the floor, and a light above it: shadows only where the file asks for them, of what it says.
TEST(OldLights, ShadowsByAttribute) {
    const std::string lights[] = {
        "LightSource \"pointlight\" 1 \"float intensity\" 4 \"point from\" [0 2 0]\n",
        "LightSource \"distantlight\" 1 \"float intensity\" 1 \"point from\" [0 1 0] \"point to\" [0 0 0]\n"};
    const struct {
        const char* shadows;
        const char* casts;
        float want;
    } cases[] = {{"", "", 1},
                 {"Attribute \"light\" \"string shadows\" \"off\"\n", "", 1},
                 {"Attribute \"light\" \"string shadows\" \"on\"\n", "", .75f},
                 {"Attribute \"light\" \"shadows\" \"on\"\n", "Attribute \"render\" \"string casts_shadows\" \"Os\"\n", .75f},
                 {"Attribute \"light\" \"string shadows\" \"on\"\n", "Attribute \"render\" \"casts_shadows\" \"none\"\n", 1},
                 {"Attribute \"light\" \"string shadows\" \"on\"\n", "Attribute \"render\" \"casts_shadows\" \"opaque\"\n", 0},
                 {"Attribute \"light\" \"string shadows\" \"on\"\n", "Attribute \"render\" \"casts_shadows\" \"shade\"\n", .75f}};
    const CameraRay below = rayTo({.3f, .4f, -.4f}, {0, 0, 0});
    for (const std::string& light : lights)
        for (const auto& c : cases) {
            std::string pane =
                std::string("AttributeBegin\n") + c.casts +
                "Surface \"constant\"\nOpacity .25 .25 .25\nPolygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
            Scene s("WorldBegin\nSides 2\n" + std::string(c.shadows) + light + pane + kFloor + "WorldEnd\n",
                    under(Hider::Hidden));
            EXPECT_NEAR(s.one(below).x, c.want, 1e-5) << c.shadows << c.casts << s.messages();
            EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
        }
}

} // namespace

} // namespace oldlights_test

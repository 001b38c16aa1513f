// Lights and loops over them in combinations that no other test has: loops in functions in loops, loops from points beside the
// surface, outputs that change between two loops, lights that trace for what is sent to them. All values follow from the lamps'
// own formulas.
#include "integrator/floorscene.h"

namespace lightadversary_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// What the floor shows whose shader has the functions and the body; lamps as RIB.
Color shows(const std::string& name, const std::string& functions, const std::string& body, const std::string& lamps,
            const std::string& others = "", Hider h = Hider::Hidden) {
    writeShader(name, "surface " + name + "(output varying float told = 1;) {\n" + functions +
                          "\n    Oi = 1; Ci = 0; vector up = vector \"world\" (0, 1, 0);\n    " + body + "\n}\n");
    return Scene(inWorld(lamps + "AttributeBegin Surface \"" + name + "\" " + kFloor + "AttributeEnd\n" + others), withShaders(h))
        .one(rayTo({.3f, .4f, -.4f}, {0, 0, 0}));
}
/// Lamps straight above at heights 2, 3 and 5 with Cl of 1, 10 and 100, and categories.
std::string lamps() {
    writeShader(
        "adlamp",
        "light adlamp(float h = 1, c = 1; string __category = \"\";) { illuminate(point \"world\" (0, h, 0)) Cl = c; }\n");
    return "LightSource \"adlamp\" 1 \"float h\" 2 \"float c\" 1 \"string __category\" \"key,warm\"\nLightSource \"adlamp\" 2 "
           "\"float h\" 3 \"float c\" 10 \"string __category\" "
           "\"warm,fill\"\nLightSource \"adlamp\" 3 \"float h\" 5 \"float c\" 100\n";
}

TEST(LightAdversary, LoopsInFunctionsInLoops) {
    const std::string f =
        "    color firstOf(string cat; point at;) { color c = 0; illuminance(cat, at) { c = Cl; if (comp(Cl, 0) > 0) return c; } "
        "return -1; }\n"
        "    float countTo(float most;) { float n = 0; illuminance(P) { n += 1; if (n >= most) break; } return n; }\n"
        "    color skipping(float which;) { color c = 0; float n = 0; illuminance(P) { n += 1; if (n == which) continue; c += "
        "Cl; } return c; }\n";
    const std::pair<const char*, float> cases[] = {
        {"Ci = firstOf(\"\", P) + firstOf(\"fill\", P) + firstOf(\"-warm\", P);", 111},
        {"Ci = firstOf(\"nobody\", P);", -1},
        {"float i; for (i = 1; i <= 4; i += 1) Ci += countTo(i);", 1 + 2 + 3 + 3},
        {"float i; for (i = 0; i < 4; i += 1) { if (i == 2) continue; Ci += skipping(i); }", 111 + 110 + 11},
        {"illuminance(\"key|fill\", P) { Ci += Cl; } illuminance(\"key&warm\", P) { Ci += 2 * Cl; } illuminance(\"-key&-fill\", "
         "P) { Ci += 3 * Cl; }",
         11 + 2 + 300},
        {"float i = 0; while (i < 3) { i += 1; illuminance(P) { if (comp(Cl, 0) > 50) break; Ci += Cl; } if (i == 2) break; }",
         22},
        // Lights above the point at height 2.5: the lamp at 2 lies behind it.
        {"illuminance(P + 2.5 * up, up, PI / 2) Ci += Cl;", 110},
        {"illuminance(P + 2.5 * up, -up, PI / 2) Ci += Cl;", 1},
        {"illuminance(P + 2.5 * up) Ci += Cl * ycomp(vtransform(\"world\", L));", -.5f + 5 + 250},
        {"illuminance(P, up, 0.001) Ci += Cl;", 111},
        {"illuminance(P, normalize(up + vector \"world\" (1, 0, 0)), 0.7) Ci += Cl;", 0}};
    int n = 0;
    for (const auto& [body, want] : cases) {
        const Color c = shows("adloop" + std::to_string(n++), f, body, lamps());
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want, 1e-4f * std::max(1.f, std::fabs(want))) << body;
    }
}

TEST(LightAdversary, OutputsThatChangeBetweenLoops) {
    writeShader("hears", "light hears(float more = 0;) { float v = 0; surface(\"told\", v); illuminate(point \"world\" (0, 2, "
                         "0)) Cl = v + more; }\n");
    const std::string lamp = "LightSource \"hears\" 1\n";
    const std::pair<const char*, float> cases[] = {
        {"illuminance(P) Ci += Cl; told = 3; illuminance(P) Ci += 10 * Cl; told = 1; illuminance(P) Ci += 100 * Cl;", 131},
        {"told = 2; illuminance(P, \"send:light:more\", 5) Ci += Cl; told = 3; illuminance(P, \"send:light:more\", 5) Ci += 10 * "
         "Cl;",
         87},
        {"float i; for (i = 1; i <= 3; i += 1) { told = i; illuminance(P) Ci += Cl; }", 6},
        {"illuminance(P) { Ci += Cl; told += 1; } illuminance(P) Ci += 10 * Cl;", 21}};
    int n = 0;
    for (const auto& [body, want] : cases)
        EXPECT_NEAR(shows("adtold" + std::to_string(n++), "", body, lamp).x, want, 1e-4) << body;
}

TEST(LightAdversary, LightsThatTraceForWhatIsSent) {
    // Panes at heights 1 and 3; the light takes the colour of the one that lies in the sent direction, as far as is sent.
    const std::string pane =
        "AttributeBegin Surface \"constant\" Color .5 .5 .5 Polygon \"P\" [-9 3 -9  -9 3 9  9 3 9  9 3 -9] AttributeEnd\n";
    writeShader("asksaway", "light asksaway(float far = 10; vector way = vector(0, 1, 0);) { illuminate(point \"world\" (0, 2, "
                            "0)) Cl = trace(Ps, vtransform(\"world\", \"current\", way), \"maxdist\", far); }\n");
    writeShader("shadowed", "light shadowed(string map = \"raytrace\"; float h = 2;) { illuminate(point \"world\" (0, h, 0)) Cl "
                            "= 1 - float shadow(map, Ps); }\n");
    const std::pair<const char*, float> cases[] = {
        {"illuminance(P) Ci += Cl;", .5f},
        {"illuminance(P, \"send:light:far\", 2) Ci += Cl; illuminance(P) Ci += 10 * Cl;", 5},
        {"illuminance(P, \"send:light:way\", vector(0, 0, 1)) Ci += Cl; illuminance(P, \"send:light:way\", vector(1, 1, 0)) Ci "
         "+= 10 * Cl;",
         5},
        {"illuminance(P + 4 * up) Ci += Cl; illuminance(P + 2 * up) Ci += 10 * Cl;", 5}}; // from above the pane there is nothing
    int n = 0;
    for (const auto& [body, want] : cases)
        EXPECT_NEAR(shows("adtrace" + std::to_string(n++), "", body, "LightSource \"asksaway\" 1\n", pane).x, want, 1e-4) << body;
    // A shadow is that of the height that is sent: the lamp at 2 lies below the pane, the one at 4 above it.
    EXPECT_NEAR(shows("adshadow", "", "illuminance(P) Ci += Cl; illuminance(P, \"send:light:h\", 4) Ci += 10 * Cl;",
                      "LightSource \"shadowed\" 1\n", pane)
                    .x,
                1, 1e-4);
}

} // namespace

} // namespace lightadversary_test

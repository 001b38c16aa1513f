// What shaders ask BMRT's ray server (rayserver.h): areashadow() in lights, rayhittest(), fulltrace() and visibility() in
// surfaces.
#include "integrator/floorscene.h"

namespace rayserver_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const CameraRay kBelow = rayTo({.3f, .4f, -.4f}, {0, 0, 0});
std::string floorOf(const std::string& surface) {
    return "Surface " + surface + "\nPolygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\n";
}
/// A pane at height 1 over the floor.
std::string pane(const std::string& opacity, const std::string& colour) {
    return "AttributeBegin Surface \"constant\" Color " + colour + " Opacity " + opacity +
           " Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] AttributeEnd\n";
}

TEST(RayServer, AreaShadowsOfLights) {
    writeShader("asked", "#include \"rayserver.h\"\nlight asked(float intensity = 4;) { illuminate(point \"world\" (0, 2, 0)) Cl "
                         "= intensity * areashadow(Ps, 4) / (L . L); }\n");
    const std::string begin = "WorldBegin\nSides 2\nLightSource \"asked\" 1\n" + floorOf("\"matte\" \"Ka\" 0 \"Kd\" 1");
    EXPECT_NEAR(Scene(begin + "WorldEnd\n", withShaders(Hider::Hidden)).one(kBelow).x, 1, 1e-5);
    EXPECT_NEAR(Scene(begin + pane(".25 .25 .25", "1 1 1") + "WorldEnd\n", withShaders(Hider::Hidden)).one(kBelow).x, .75, 1e-5);
    EXPECT_NEAR(Scene(begin + pane("1 1 1", "1 1 1") + "WorldEnd\n", withShaders(Hider::Hidden)).one(kBelow).x, 0, 1e-5);
}

TEST(RayServer, WhatSurfacesAsk) {
    // Distance, height of the hit and visibility of a point above; with fulltrace whether, the colour, and where what missed
    // goes.
    writeShader(
        "hittest",
        "#include \"rayserver.h\"\nsurface hittest() { point h = P; vector n = 0; vector up = vector \"world\" (0, 1, 0);\n"
        "    float d = rayhittest(P, up, h, n); Oi = 1; Ci = color(d, ycomp(transform(\"world\", h)), comp(visibility(P, P + 3 * "
        "up), 0)); }\n");
    writeShader("fullasks", "#include \"rayserver.h\"\nsurface fullasks() { color c = 0; float d = 0; point h = P, m = 0; vector "
                            "n = 0, r = 0; vector up = vector \"world\" (0, 1, 0);\n"
                            "    float found = fulltrace(P, up, c, d, h, n, m, r); Oi = 1; Ci = color(found, comp(c, 0), (found "
                            "== 1) ? d : ycomp(vtransform(\"world\", r))); }\n");
    const auto of = [](const char* surface, bool covered) {
        return Scene("WorldBegin\nSides 2\n" + floorOf(std::string("\"") + surface + "\"") +
                         (covered ? pane("1 1 1", ".5 .25 0") : "") + "WorldEnd\n",
                     withShaders(Hider::Raytrace))
            .one(kBelow);
    };
    const Color hit = of("hittest", true), miss = of("hittest", false), full = of("fullasks", true),
                nothing = of("fullasks", false);
    EXPECT_NEAR(hit.x, 1, 1e-3);
    EXPECT_NEAR(hit.y, 1, 1e-3);
    EXPECT_EQ(hit.z, 0);
    EXPECT_GT(miss.x, 1e18f); // colours are held below 2^60
    EXPECT_NEAR(miss.y, 0, 1e-5);
    EXPECT_EQ(miss.z, 1);
    EXPECT_EQ(full.x, 1);
    EXPECT_NEAR(full.y, .5, 1e-6);
    EXPECT_NEAR(full.z, 1, 1e-3);
    EXPECT_EQ(nothing.x, 0);
    EXPECT_EQ(nothing.y, 0);
    EXPECT_NEAR(nothing.z, 1, 1e-6);
}

} // namespace

} // namespace rayserver_test

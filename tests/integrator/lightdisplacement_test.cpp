// displacement() in lights: what the displacement shader of the lit primitive wrote, however the light comes to the surface.
#include "integrator/floorscene.h"

namespace lightdisplacement_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// A small one: it is diced.
const char kTile[] = "ShadingRate 25 Polygon \"P\" [-2 0 -2  -2 0 2  2 0 2  2 0 -2]\n";

class LightDisplacement : public ::testing::TestWithParam<Hider> {
protected:
    void SetUp() override {
        writeShader("tells", "displacement tells(float k = 1; output varying float told = 0; output varying color tint = 0;) { "
                             "told = 7 + k; tint = color(1, k, 3); }\n");
        writeShader("silent", "displacement silent(output varying float told = 4;) { N = normalize(N); }\n");
        writeShader("sums", "surface sums() { Oi = 1; Ci = 0; illuminance(P) Ci += Cl; }\n");
        writeShader("spreads", "surface spreads() { Oi = Os; Ci = Os * diffuse(normalize(N)); }\n");
    }
    /// The floor under a light 2 above it whose Cl is computed so.
    Color seen(const std::string& name, const std::string& body, const std::string& surface, const std::string& displacement) {
        writeShader(name,
                    "light " + name +
                        "() { float v = -1, k = -1; color c = -1; string told = (xcomp(Ps) > 1e9) ? \"x\" : \"told\";\n    " +
                        body + "\n    illuminate(point \"world\" (0, 2, 0)) Cl = color(v, k, comp(c, 2)); }\n");
        Scene s(inWorld("LightSource \"" + name + "\" 1\nSurface \"" + surface + "\" " + displacement + kTile),
                under(GetParam()));
        return s.one(kView);
    }
};

TEST_P(LightDisplacement, WhatWasWritten) {
    for (const char* surface : {"sums", "spreads"}) {
        const std::string end = surface;
        const Color both = seen("asks" + end, "displacement(\"told\", v); displacement(\"k\", k); displacement(\"tint\", c);",
                                surface, "Displacement \"tells\" \"k\" 2\n");
        EXPECT_NEAR(both[0], 9, 1e-4) << surface;
        EXPECT_NEAR(both[1], 2, 1e-4) << surface;
        EXPECT_NEAR(both[2], 3, 1e-4) << surface;
        EXPECT_NEAR(seen("named" + end, "displacement(told, v); k = 1; c = 1;", surface, "Displacement \"tells\"\n")[0], 8, 1e-4)
            << "a name made when it runs";
        EXPECT_NEAR(seen("quiet" + end, "displacement(\"told\", v); k = 1; c = 1;", surface, "Displacement \"silent\"\n")[0], 4,
                    1e-4)
            << "as the scene gave it";
        EXPECT_NEAR(seen("nobody" + end, "k = displacement(\"told\", v); v = 1 + k; k = 1; c = 1;", surface, "")[0], 1, 1e-4)
            << "there is none";
    }
}

INSTANTIATE_TEST_SUITE_P(Hiders, LightDisplacement, ::testing::Values(Hider::Hidden, Hider::Path),
                         [](const auto& i) { return i.param == Hider::Path ? "Path" : "Hidden"; });

// A ball of radius 1/2 whose centre is 2 above the floor, of the radiance that the displacement of the floor outputs: a sixteenth
// of it, whether it is sampled or met by a ray.
TEST(LightDisplacementPath, EmittersThatAreMet) {
    writeShader("tells", "displacement tells(float k = 1; output varying float told = 0; output varying color tint = 0;) { told "
                         "= 7 + k; tint = color(1, k, 3); }\n");
    writeShader("glows", "light glows() { float v = 0; displacement(\"told\", v); illuminate(P, N, PI / 2) Cl = v; }\n");
    const std::string rib = inWorld(
        "AttributeBegin Surface \"constant\" Color 0 0 0 Attribute \"light\" \"string units\" \"radiance\" AreaLightSource "
        "\"glows\" 1 Translate 0 2 0 Sphere .5 -.5 .5 360 AttributeEnd\nIlluminate 1 1\n"
        "Surface \"matte\" Displacement \"tells\" " +
        std::string(kTile));
    for (const bool only : {false, true}) {
        Settings s = withShaders(Hider::Path);
        s.bsdfOnly = only;
        Scene scene(rib, s);
        expectMean(scene.estimate(kView, samples(8000)), 8. / 16, only ? .05 : .02, only ? "met" : "sampled");
    }
}

} // namespace

} // namespace lightdisplacement_test

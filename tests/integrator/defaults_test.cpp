// Defaults of parameters that read earlier parameters or the point itself (docs/language.md), and shaders that share a file.
// Closed forms.
#include "integrator/floorscene.h"

namespace defaults_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"st\" [0 0 1 0 1 1 0 1]\n";

Color seen(const std::string& world, Vec3 at = {.2f, .3f, 2}) {
    Scene s("WorldBegin\n" + world + kSquare + "WorldEnd\n");
    return s.one(rayTo({0, 0, 0}, at));
}

void expectNear(Color a, Color b) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f) << c;
}

void writeEarlier() {
    writeShader(
        "defaultsearlier",
        "float twice(float x) { return 2 * x; }\nsurface defaultsearlier(float k = 2; float k2 = k * 3, list[2] = {k2, k}; "
        "string n = \"a\", m = concat(n, \"b\");"
        " varying float w = k2 + 1;) { Ci = color(k2, list[0] + 10 * list[1], w); if (m == \"qb\") Ci += 100; Oi = 1; }\n");
}

TEST(Defaults, ReadTheValuesOfEarlierParameters) {
    writeEarlier();
    expectNear(seen("Surface \"defaultsearlier\"\n"), {6, 26, 7});
    expectNear(seen("Surface \"defaultsearlier\" \"uniform float k\" [4]\n"), {12, 52, 13});
    expectNear(seen("Surface \"defaultsearlier\" \"uniform float k2\" [1]\n"), {1, 21, 2});
    expectNear(seen("Surface \"defaultsearlier\" \"uniform float k\" [4] \"uniform string n\" [\"q\"]\n"), {112, 152, 113});
    expectNear(seen("Surface \"defaultsearlier\" \"uniform float k\" [4] \"varying float w\" [5]\n"), {12, 52, 5});
}

// An earlier parameter that a primitive variable overrides differs from point to point, and so does what reads it.
TEST(Defaults, ReadPrimitiveVariablesOfEarlierParameters) {
    writeEarlier();
    Scene s("WorldBegin\nSurface \"defaultsearlier\"\nPolygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"varying float k\" [0 2 2 "
            "0]\nWorldEnd\n");
    expectNear(s.one(rayTo({0, 0, 0}, {.5f, .3f, 2})), {4.5f, 19.5f, 5.5f}); // k = x + 1
}

TEST(Defaults, OfVaryingParametersAreOneASample) {
    writeShader("defaultsvarying", "float half(float x) { extern float t; return t / 2 + x; }\n"
                                   "surface defaultsvarying(varying float a = s * 2; varying float b = a + 1; varying point p = "
                                   "P; varying float h = half(1);) {"
                                   " Ci = color(a, b, h) + color(100 * distance(p, P)); Oi = 1; }\n");
    const Color c = seen("Surface \"defaultsvarying\"\n", {.5f, .2f, 2}); // s = .75, t = .6
    expectNear(c, {1.5f, 2.5f, 1.3f});
    expectNear(seen("Surface \"defaultsvarying\" \"varying float a\" [4]\n", {.5f, .2f, 2}), {4, 5, 1.3f});
}

TEST(Defaults, OfCoShaders) {
    writeShader("defaultslayer", "class defaultslayer(float k = 1; float j = k * 2; varying float a = s;) { public void "
                                 "ask(output color c) { c = color(k, j, a); } }\n");
    writeShader("defaultsasks", "class defaultsasks() { public void surface(output color Ci, Oi) { shader l = getshader(\"a\"); "
                                "Oi = 1; l->ask(Ci); } }\n");
    expectNear(seen("Surface \"defaultsasks\"\nShader \"defaultslayer\" \"a\" \"uniform float k\" [3]\n", {.5f, .2f, 2}),
               {3, 6, .75f});
}

// A file may hold several shaders: PRMan's compiler wrote a .slo for each.
TEST(Defaults, ShadersOfOneFileAreFoundByTheirNames) {
    writeShader("defaultsfile", "// surface defaultsnone(\nsurface defaultsfile() { Ci = 1; Oi = 1; "
                                "}\nsurface\ndefaultssecond(float k = 3;) { Ci = k; Oi = 1; }\n");
    expectNear(seen("Surface \"defaultssecond\" \"uniform float k\" [5]\n"), {5, 5, 5});
    expectNear(seen("Surface \"defaultsfile\"\n"), {1, 1, 1});
}

TEST(Defaults, TheImagerBackgroundTakesItsColourAsColor) {
    Scene s(std::string("Imager \"background\" \"uniform color color\" [.25 .5 1]\nWorldBegin\n") + kSquare + "WorldEnd\n",
            withShaders(Hider::Hidden));
    const float x[1] = {.5f}, y[1] = {.5f};
    float r[1] = {.1f}, g[1] = {.1f}, b[1] = {.1f}, a[1] = {.5f}; // over a half covered pixel half of it
    ASSERT_TRUE(s.world->runImager(1, x, y, r, g, b, a, s.diagnostics));
    EXPECT_EQ(s.messages(), "");
    expectNear(Color(r[0], g[0], b[0]), {.225f, .35f, .6f});
}

} // namespace

} // namespace defaults_test

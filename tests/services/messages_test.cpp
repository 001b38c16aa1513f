// What the shaders of a primitive tell each other, in rendered scenes: parameters and outputs of surface, displacement and
// atmosphere.
#include "integrator/floorscene.h"

namespace messages_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const std::string kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";
/// Meets the square at (.2, .3).
const CameraRay kMiddle = rayTo({0, 0, 0}, {.2f, .3f, 2});

/// Large micropolygons: it stays flat, and fine ones of a picture of 640 pixels took nearly all the time.
std::string displaced(const std::string& shaders) {
    return inWorld("ShadingRate 64\nAttribute \"displacementbound\" \"float sphere\" [1]\n" + shaders + kSquare);
}

void expectNear(const Color& c, const Color& want, float tolerance, const std::string& what) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], tolerance) << what << " " << k;
}

/// hump = 3 x + 5 y in world space; the square stays flat.
void writeHump() {
    writeShader("humps",
                R"(displacement humps(float given = 7; output varying float hump = 1; output varying color tints[2] = {0, 0};
                                               output varying point where = 0; output varying string word = "none";
                                               output uniform float plain = 4;) {
    point Q = transform("world", P);
    hump = 3 * xcomp(Q) + 5 * ycomp(Q);
    tints[0] = color(xcomp(Q), 0, 0);
    tints[1] = color(0, ycomp(Q), given);
    where = P;
    word = xcomp(Q) > 0 ? "right" : "left";
    plain = given * 2;
}
)");
}

class Hiders : public ::testing::TestWithParam<Hider> {};
INSTANTIATE_TEST_SUITE_P(Messages, Hiders, ::testing::Values(Hider::Hidden, Hider::Path));

// What the displacement shader wrote, at the point that is shaded; not what it was given.
TEST_P(Hiders, OutputsOfTheDisplacement) {
    writeHump();
    writeShader("hears", R"(surface hears() {
    float h = -1, given = -1;
    float found = displacement("hump", h) * displacement("given", given);
    Oi = 1; Ci = color(found, h, given);
}
)");
    Scene s(displaced("Displacement \"humps\" \"float given\" 9 \"float hump\" 2\nSurface \"hears\"\n"), under(GetParam()));
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    expectNear(s.one(kMiddle), Color(1, 3 * .2f + 5 * .3f, 9), 1e-5f, "hump");
    expectNear(s.one(rayTo({0, 0, 0}, {-.5f, .1f, 2})), Color(1, -1.5f + .5f, 9), 1e-5f, "hump elsewhere");
}

// Its derivatives are those of the displacement shader: u and v of a polygon are object x and y.
TEST_P(Hiders, OutputsOfTheDisplacementHaveDerivatives) {
    writeHump();
    writeShader(
        "slopes",
        "surface slopes() { float h = 0; displacement(\"hump\", h); Oi = 1; Ci = color(Du(h), Dv(h), h * 0 + Du(h * h)); }\n");
    Scene s(displaced("Attribute \"shade\" \"string derivatives\" \"exact\"\nDisplacement \"humps\"\nSurface \"slopes\"\n"),
            under(GetParam()));
    const float h = 3 * .2f + 5 * .3f;
    expectNear(s.one(kMiddle), Color(3, 5, 2 * h * 3), 1e-4f, "slopes");
}

// Arrays, fixed and growing; points; strings; names that are made when the shader runs.
TEST_P(Hiders, OutputsOfTheDisplacementOfEveryKind) {
    writeHump();
    writeShader("hearsall", R"(surface hearsall(float what = 0;) {
    color two[2] = {0, 0}, more[] = {};
    point p = 0;
    string w = "", names[2] = {"hump", "given"};
    float found = displacement("tints", two) + displacement("tints", more) + displacement("where", p) + displacement("word", w);
    float h = 0, g = 0;
    displacement(names[0], h);
    float i = xcomp(P) > 5 ? 0 : 1;
    displacement(names[i], g);
    Oi = 1;
    if (what == 0) Ci = color(found, arraylength(more), w == "right" ? 1 : w == "left" ? -1 : 0);
    else if (what == 1) Ci = two[0] + two[1];
    else if (what == 2) Ci = more[0] + more[1];
    else Ci = color(h, g, distance(p, P));
}
)");
    auto of = [&](const char* what) {
        return Scene(displaced(std::string("Displacement \"humps\"\nSurface \"hearsall\" \"what\" ") + what + "\n"),
                     under(GetParam()))
            .one(kMiddle);
    };
    expectNear(of("0"), Color(4, 2, 1), 1e-5f, "found");
    expectNear(of("1"), Color(.2f, .3f, 7), 1e-5f, "fixed array");
    expectNear(of("2"), Color(.2f, .3f, 7), 1e-5f, "growing array");
    expectNear(of("3"), Color(3 * .2f + 5 * .3f, 7, 0), 1e-5f, "by name");
}

// What does not fit leaves the variable: another type, a varying output for a uniform variable, an array for a single value, a
// longer array.
TEST_P(Hiders, WhatDoesNotFitIsNotTold) {
    writeHump();
    writeShader("misfits", R"(surface misfits() {
    color c = 5; uniform float u = 6; float f = 7, long[3] = {8, 8, 8}; string s = "kept"; uniform float p = 0;
    float found = displacement("hump", c) + displacement("hump", u) + displacement("tints", f) + displacement("tints", long)
        + displacement("hump", s) + displacement("nosuch", f);
    float fits = displacement("plain", p);
    Oi = 1; Ci = color(found + fits * 10, comp(c, 0) + u + f + long[2], s == "kept" ? p : 0);
}
)");
    Scene s(displaced("Displacement \"humps\"\nSurface \"misfits\"\n"), under(GetParam()));
    EXPECT_EQ(s.one(kMiddle), Color(10, 5 + 6 + 7 + 8, 14));
}

// While dicing and when it runs again at the point the displacement shader finds the other shaders of the primitive, and their
// names.
TEST_P(Hiders, TheDisplacementAsksTheOthers) {
    writeShader("asksothers", R"(displacement asksothers() {
    float push = 0, haze = 0, own = 0;
    float found = surface("push", push) + atmosphere("haze", haze) + displacement("own", own);
    string a = shadername("surface"), b = shadername("displacement"), c = shadername();
    if (found == 2 && a == "pushes" && b == "asksothers" && c == "asksothers") P += vector "world" (0, 0, -push * haze);
}
)");
    writeShader("pushes", "surface pushes(float push = .25;) { Oi = 1; Ci = color(zcomp(transform(\"world\", P)), 0, 0); }\n");
    writeShader("still", "volume still(float haze = 2;) { Ci = Ci; Oi = Oi; }\n");
    Scene s(displaced("Atmosphere \"still\"\nDisplacement \"asksothers\"\nSurface \"pushes\" \"push\" .4\n"), under(GetParam()));
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.1f, .2f, 1.2f})).x, 2 - .8f, 1e-4);
}

// An atmosphere finds parameters of the others, outputs of the surface as they are when it has run, and those of the
// displacement.
TEST_P(Hiders, TheAtmosphereAsksTheOthers) {
    writeHump();
    writeShader("tells", "surface tells(float given = 5; output varying float out = 1; output varying color list[2] = {0, 0};) { "
                         "out = 10 * xcomp(transform(\"world\", P)); list[1] = color(0, 0, 3); Oi = 1; Ci = .5; }\n");
    writeShader("listens", R"(volume listens(float what = 0;) {
    float out = -1, given = -1, hump = -1;
    color list[2] = {0, 0};
    float found = surface("out", out) + surface("given", given) + displacement("hump", hump) + surface("list", list);
    string n = shadername("surface"), own = shadername();
    Oi = 1;
    if (what == 0) Ci = color(found, out, given);
    else Ci = color(hump, comp(list[1], 2), (n == "tells" ? 1 : 0) + (own == "listens" ? 2 : 0));
}
)");
    auto of = [&](const char* what) {
        return Scene(displaced(std::string("Displacement \"humps\"\nSurface \"tells\"\nAtmosphere \"listens\" \"what\" ") + what +
                               "\n"),
                     under(GetParam()))
            .one(kMiddle);
    };
    expectNear(of("0"), Color(4, 2, 5), 1e-5f, "outputs of the surface");
    expectNear(of("1"), Color(3 * .2f + 5 * .3f, 3, 3), 1e-5f, "displacement");
}

// A surface asks its atmosphere and the primitive's own values for parameters of other shaders.
TEST_P(Hiders, ParametersThatThePrimitiveOverrides) {
    writeShader("bump", "displacement bump(varying float height = 1;) { P += 0 * N; }\n");
    writeShader("asksbump", "surface asksbump() { float h = 0; displacement(\"height\", h); Oi = 1; Ci = h; }\n");
    Scene s(inWorld("Displacement \"bump\"\nSurface \"asksbump\"\nPolygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"varying float "
                    "height\" [0 2 2 0]\n"),
            under(GetParam()));
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.5f, .1f, 2})).x, 1.5f, 1e-5); // 0 at x = -1, 2 at x = 1
}

// A shadow's opacity hears the displacement too: .25 of the light of 1 is left where hump is .75.
TEST(Messages, OpacityHearsTheDisplacement) {
    writeShader("veil", "displacement veil(output varying float cover = 0;) { cover = .75; }\n");
    writeShader("veiled", "surface veiled() { float c = 0; displacement(\"cover\", c); Oi = c; Ci = 0; }\n");
    writeShader(
        "sun", "light sun() { solar(vector \"world\" (0, -1, 0), 0) Cl = transmission(Ps, Ps + vector \"world\" (0, 9, 0)); }\n");
    writeShader("sums1", "surface sums1() { Oi = 1; Ci = 0; illuminance(P, vector \"world\" (0, 1, 0), PI) Ci += Cl; }\n");
    const std::string card =
        "AttributeBegin\nShadingRate 64\nAttribute \"visibility\" \"transmission\" 1\nAttribute \"displacementbound\" "
        "\"float sphere\" [.1]\nDisplacement \"veil\"\nSurface \"veiled\"\n"
        "Polygon \"P\" [-1 5 19  -1 5 21  1 5 21  1 5 19]\nAttributeEnd\n";
    Scene s(inWorld("LightSource \"sun\" 1\n" + card + "Surface \"sums1\"\n" + kFloor), under(Hider::Raytrace));
    expectNear(s.one(rayTo({.3f, .8f, 19.6f}, {0, 0, 20})), Color(.25f), 1e-5f, "shadow");
}

} // namespace

} // namespace messages_test

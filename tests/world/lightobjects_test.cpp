// Class lights as shader objects: surfaces call their public methods and read their public members by the handles of getlights().
// The floor y = 0 is seen at the origin; a light that stands at height h has its own origin there.
#include "integrator/floorscene.h"
#include "world/lightobjects.h"

namespace lightobjects_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface \"" + surface + "\"\n" + kFloor +
           "AttributeEnd\nWorldEnd\n";
}
std::string at(float height, const std::string& request) {
    return "TransformBegin\nTranslate 0 " + std::to_string(height) + " 0\n" + request + "\nTransformEnd\n";
}
void expectEverywhere(const std::string& rib, Color want, const std::string& what, int warnings = 0) {
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(rib, under(h, suspend));
            const Color c = s.one(kView);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], want[k], 1e-4 * std::max(1.f, want[k]))
                    << what << ", hider " << int(h) << (suspend ? ", suspended" : "") << s.messages();
            EXPECT_EQ(s.diagnostics.warnings(), warnings) << what << s.messages();
        }
}
/// A light that gives a surface `samples` directions to its origin, each with its share of the intensity; its Cl is that of a
/// point light.
void writeSampled() {
    writeShader("sampled", R"(class sampled(uniform float samples = 4; uniform float intensity = 8;) {
    constant point centre = point "shader" (0, 0, 0);
    public constant float shares = 1;
    public constant color tint = color(1, 2, 3);
    public void construct() { shares = intensity / samples; }
    public float twice(float x) { return 2 * x * intensity; }
    public void light(output vector L; output color Cl; point p = (0, 0, 0); output color sent[] = {};
                      output vector directions[] = {};) {
        uniform float s;
        resize(sent, samples);
        resize(directions, samples);
        for (s = 0; s < samples; s += 1) { sent[s] = shares; directions[s] = centre - p; }
        L = Ps - centre;
        Cl = intensity / (L . L);
    }
}
)");
}
void writeAsking(const std::string& name, const std::string& body) {
    writeShader(name, "class " + name +
                          "() { public void surface(output color Ci, Oi) {\n    shader lights[] = getlights();\n"
                          "    uniform float i, n = arraylength(lights); vector L; color Cl; Ci = 0; Oi = 1;\n" +
                          body + "\n} }\n");
}
constexpr char kSum[] = R"(    for (i = 0; i < n; i += 1) {
        color sent[]; vector directions[]; uniform float s;
        lights[i]->light(L, Cl, "p", P, "sent", sent, "directions", directions);
        for (s = 0; s < arraylength(sent); s += 1) Ci += color(1, ycomp(vtransform("world", directions[s])), comp(sent[s], 0));
    })";

TEST(LightObjects, TheirLightMethodGivesWhatItsParametersAre) {
    writeSampled();
    writeAsking("asksall", kSum);
    // Four samples, each 3 high and a quarter of 8.
    expectEverywhere(scene(at(3, "LightSource \"sampled\" 1"), "asksall"), Color(4, 12, 8), "one light");
    // Each light has its own place and its own parameters.
    expectEverywhere(
        scene(at(3, "LightSource \"sampled\" 1") + at(5, "LightSource \"sampled\" 2 \"samples\" 2 \"intensity\" 1"), "asksall"),
        Color(6, 22, 9), "two lights");
}

TEST(LightObjects, OtherLightsLeaveTheArgumentsAsTheyAre) {
    writeSampled();
    writeAsking("asksall", kSum);
    expectEverywhere(scene("LightSource \"pointlight\" 2\n" + at(3, "LightSource \"sampled\" 1"), "asksall"), Color(4, 12, 8),
                     "beside a point light");
    Scene s(scene("LightSource \"pointlight\" 2\n", "asksall"), under(Hider::Hidden));
    EXPECT_EQ(s.one(kView).x, 0);
    EXPECT_NE(s.messages().find("only class lights whose light() has these parameters"), std::string::npos) << s.messages();
}

// As exporters of 3Delight write it: the surface hands everything to an integrator, which asks the lights.
TEST(LightObjects, ACoShaderAsksThem) {
    writeSampled();
    writeShader("integrates",
                "class integrates() { public void integrate(output color Ci, Oi) {\n    shader lights[] = getlights();\n"
                "    uniform float i, n = arraylength(lights), d; vector L; color Cl; Ci = 0; Oi = 1; rayinfo(\"depth\", d);\n"
                "    if (d > 2) return;\n" +
                    std::string(kSum) + "\n    Ci *= transmission(P, P + vector(0, 1e-3, 0));\n} }\n");
    // No warning either: P is handed to the lights, and none of them moves it.
    writeShader("handsover", "class handsover() { public void surface(output color Ci, Oi) { shader to = getshader(\"to\"); "
                             "to->integrate(Ci, Oi); } }\n");
    expectEverywhere(scene("Shader \"integrates\" \"to\"\n" + at(3, "LightSource \"sampled\" 1") +
                               at(5, "LightSource \"sampled\" 2 \"samples\" 2 \"intensity\" 1"),
                           "handsover"),
                     Color(6, 22, 9), "two lights");
}

TEST(LightObjects, MethodsAndMembers) {
    writeSampled();
    writeAsking("members",
                "    Ci = color(lights[0]->shares, lights[0]->twice(3), comp(lights[0]->tint, 2) + lights[0]->samples);");
    expectEverywhere(scene(at(3, "LightSource \"sampled\" 1"), "members"), Color(2, 48, 7), "members");
}

TEST(LightObjects, ThePlainCallIsTheRenderersStill) {
    writeSampled();
    writeAsking("plain",
                "    lights[0]->light(L, Cl); Ci = color(comp(Cl, 0), -ycomp(vtransform(\"world\", L)), lights[0]->shares);");
    expectEverywhere(scene(at(2, "LightSource \"sampled\" 1"), "plain"), Color(2, 2, 2), "plain call");
}

TEST(LightObjects, AMethodThatALightHasNotIsSaidWhereItIsCalled) {
    writeSampled();
    writeShader("other", "class other() { public float once(float x) { return x; } public void light(output vector L; output "
                         "color Cl;) { L = vector(0, -1, 0); Cl = 1; } }\n");
    writeAsking("calls", "    for (i = 0; i < n; i += 1) Ci += lights[i]->once(1) + lights[i]->twice(1);");
    Scene s(scene("LightSource \"other\" 1\n" + at(3, "LightSource \"sampled\" 2"), "calls"), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, 17, 1e-4) << s.messages();
    EXPECT_NE(s.messages().find("has no public method 'twice'"), std::string::npos) << s.messages();
}

TEST(CoShaders, TheirShaderSpaceIsWhereTheyWereNamed) {
    writeShader("place", R"(class place() {
    point origin = point "shader" (0, 0, 0);
    public color where() {
        color across = color(transform("shader", "world", point(0, 1, 0)) - point(0, 0, 0));
        return across + color(0, 0, ycomp(transform("world", origin)));
    }
}
)");
    writeShader("asksplace", "class asksplace() { public void surface(output color Ci, Oi) { shader h = getshader(\"h\"); Ci = "
                             "h->where(); Oi = 1; } }\n");
    for (float height : {0.f, 4.f})
        expectEverywhere("WorldBegin\nSides 2\n" + at(height, "Shader \"place\" \"h\"\nCoordinateSystem \"there\"") +
                             "AttributeBegin\nShader \"place\" \"unused\"\n" + at(height, "") + "AttributeEnd\nAttributeBegin\n" +
                             "Surface \"asksplace\"\n" + kFloor + "AttributeEnd\nWorldEnd\n",
                         Color(0, height + 1, height), "co-shader at " + std::to_string(height));
}

TEST(LightObjects, NamesOfPlacesKeepEveryDigit) {
    Matrix m, back;
    for (int k = 0; k < 16; ++k) m.m[k / 4][k % 4] = 1.0 / (k + 3) * (k % 2 ? -1e9 : 1e-9);
    ASSERT_TRUE(placeOf(spaceAt(m), back));
    EXPECT_TRUE(m == back);
    for (const char* name : {"shader", "shader@", "shader@1 2 3", "world", ""}) EXPECT_FALSE(placeOf(name, back)) << name;
}

TEST(LightObjects, ALightWithoutMethodsSaysSo) {
    writeShader("plain", "light plain() { solar(vector \"world\" (0, -1, 0), 0) Cl = 1; }\n");
    writeShader("asksplain", "surface asksplain(float any = 1;) { shader all[] = getlights(); Oi = 1; Ci = .25;\n  if (any == 1) "
                             "Ci += all[0]->twice(3); }\n");
    for (const auto& [given, said] : {std::pair{"", 1}, {" \"any\" 0", 0}}) {
        Scene s("WorldBegin\nSides 2\nLightSource \"plain\" 1\nSurface \"asksplain\"" + std::string(given) + "\n" + kFloor +
                    "WorldEnd\n",
                under(Hider::Hidden));
        EXPECT_NEAR(s.one(kView)[0], .25f, 1e-6f);
        EXPECT_EQ(s.messages().find("asksplain.sl:2:29") != std::string::npos &&
                      s.messages().find("has no method 'twice'") != std::string::npos,
                  said == 1)
            << s.messages();
    }
}

} // namespace

} // namespace lightobjects_test

// illuminance in all its forms, and lights by their handles. A large floor y = 0 seen at the origin; a point light of intensity I
// at height h straight above gives Cl = I / h^2 there, L = (0, h, 0). Under path the same, for nothing lies between.
#include "base/limits.h"
#include "integrator/floorscene.h"

namespace lightloop_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::string scene(const std::string& lights, const std::string& surface) {
    return "WorldBegin\nSides 2\n" + lights + "AttributeBegin\nSurface " + surface + "\n" + kFloor + "AttributeEnd\nWorldEnd\n";
}
/// A surface with the body of a function that sets Ci.
void surfaceOf(const std::string& name, const std::string& body, const std::string& parameters = "") {
    writeShader(name, "surface " + name + "(" + parameters + ") {\n    Ci = 0; Oi = 1;\n" + body + "\n}\n");
}
/// Light of constant Cl = c, h above the origin, of categories.
void writeLights() {
    writeShader(
        "flat",
        R"(light flat(float c = 1; float h = 2; string __category = ""; float __nondiffuse = 0; float __nonspecular = 0;) {
    illuminate(point "world" (0, h, 0)) Cl = c;
}
)");
}
std::string flat(int handle, float c, float h = 2, const std::string& more = "") {
    return "LightSource \"flat\" " + std::to_string(handle) + " \"float c\" " + std::to_string(c) + " \"float h\" " +
           std::to_string(h) + " " + more + "\n";
}
std::string category(const std::string& c) { return "\"string __category\" \"" + c + "\""; }

/// The same value at every hider, waiting for rays or not.
void expectEverywhere(const std::string& rib, Color want, const std::string& what) {
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (bool suspend : {false, true}) {
            Scene s(rib, under(h, suspend));
            const Color c = s.one(kView);
            for (int k = 0; k < 3; ++k)
                EXPECT_NEAR(c[k], want[k], 1e-5 * std::max(1.f, want[k]))
                    << what << ", hider " << int(h) << (suspend ? ", suspended" : "") << s.messages();
            EXPECT_EQ(s.diagnostics.warnings(), 0) << what << s.messages();
        }
}

TEST(Illuminance, Forms) {
    writeLights();
    const std::string lights = flat(1, 1, 2, category("a")) + flat(2, 4, 3, category("b")) + flat(3, 16, -2, category("a,b"));
    const struct {
        const char* head;
        float want;
    } cases[] = {{"P", 21},
                 {"\"\", P", 21},
                 {"\"a\", P", 17},
                 {"\"b\", P", 20},
                 {"\"-a\", P", 4},
                 {"\"a|b\", P", 21},
                 {"\"a&b\", P", 16},
                 {"\"a,-b\", P", 1},
                 {"P, normal \"world\" (0, 1, 0), PI / 2", 5},
                 {"P, vector \"world\" (0, 1, 0), .1", 5},
                 {"P, vector \"world\" (0, -1, 0), .1", 16},
                 {"P, vector \"world\" (1, 0, 0), 1", 0},
                 {"\"a\", P, normal \"world\" (0, 1, 0), PI / 2", 1},
                 {"P, \"lightcache\", \"reuse\"", 21},
                 {"\"b\", P, vector \"world\" (0, 1, 0), 1, \"lightcache\", \"refresh\"", 4}};
    for (const auto& c : cases) {
        surfaceOf("forms", std::string("    illuminance(") + c.head + ") Ci += Cl;");
        expectEverywhere(scene(lights, "\"forms\""), Color(c.want), c.head);
    }
}

TEST(Illuminance, CategoryKnownOnlyWhenItRuns) {
    writeLights();
    // One of the categories on each side of the floor.
    surfaceOf(
        "later",
        "    string which = \"a\"; if (xcomp(transform(\"world\", P)) > 0) which = \"b\";\n    illuminance(which, P) Ci += Cl;");
    Scene s(scene(flat(1, 1, 2, category("a")) + flat(2, 4, 3, category("b")), "\"later\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(rayTo({-1, 2, 0}, {-1, 0, 0.1f})).x, 1, 1e-5);
    EXPECT_NEAR(s.one(rayTo({1, 2, 0}, {1, 0, 0.1f})).x, 4, 1e-5);
    const CameraRay both[] = {rayTo({-1, 2, 0}, {-1, 0, 0.1f}), rayTo({1, 2, 0}, {1, 0, 0.1f})}; // in one strip
    auto r = s.trace(both);
    EXPECT_NEAR(r[0].color.x, 1, 1e-5);
    EXPECT_NEAR(r[1].color.x, 4, 1e-5);
}

TEST(Illuminance, ACategoryThatCannotBeReadIsSaid) {
    writeLights();
    surfaceOf("badcategory", "    illuminance(\"a|\", P) Ci += Cl;");
    Scene s(scene(flat(1, 3, 2, category("b")), "\"badcategory\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, 3, 1e-5);
    EXPECT_NE(s.messages().find("cannot be read"), std::string::npos) << s.messages();
}

TEST(Illuminance, BreakContinueReturn) {
    writeLights();
    const std::string lights = flat(1, 1) + flat(2, 10) + flat(3, 100);
    const struct {
        const char* body;
        float want;
    } cases[] = {
        {"illuminance(P) { Ci += Cl; if (comp(Cl, 0) > 5) break; }", 11},
        {"illuminance(P) { if (comp(Cl, 0) > 5 && comp(Cl, 0) < 50) continue; Ci += Cl; }", 101},
        {"float i; for (i = 0; i < 3; i += 1) { illuminance(P) { Ci += Cl; if (comp(Cl, 0) > 5) break 2; } }", 11},
        {"float i; for (i = 0; i < 3; i += 1) { illuminance(P) { if (comp(Cl, 0) > 5) continue 2; Ci += Cl; } }", 3},
        {"color first() { extern point P; illuminance(P) { if (comp(Cl, 0) > 5) return Cl; } return 7; } Ci = first();", 10},
        {"color none() { extern point P; illuminance(P) { if (comp(Cl, 0) > 500) return Cl; } return 7; } Ci = none();", 7}};
    for (const auto& c : cases) {
        surfaceOf("leaving", std::string("    ") + c.body);
        expectEverywhere(scene(lights, "\"leaving\""), Color(c.want), c.body);
    }
}

// Parameters of the light after it has run: outputs that it has written, others as given.
TEST(Illuminance, ParametersOfTheLight) {
    writeShader(
        "tells",
        R"(light tells(float c = 2; output varying float doubled = 0; output varying color tint = 0; string name = "sun";) {
    illuminate(point "world" (0, 2, 0)) { doubled = 2 * c; tint = color(length(L), 1, 0); Cl = c; }
}
)");
    const struct {
        const char* body;
        Color want;
    } cases[] = {{"float d = 0; illuminance(P, \"light:doubled\", d) Ci += d;", {6, 6, 6}},
                 {"float d = 9; illuminance(P, \"light:missing\", d) Ci += d;", {9, 9, 9}},
                 {"float d = 9; illuminance(P, \"light:name\", d) Ci += d;", {9, 9, 9}}, // of another type
                 {"string n = \"\"; illuminance(P, \"light:name\", n) { if (n == \"sun\") Ci += 1; }", {1, 1, 1}},
                 {"color t = 0; float d = 0; illuminance(P, \"light:tint\", t, \"light:doubled\", d) Ci += t * d;", {12, 6, 0}},
                 {"float c = 0; illuminance(P, \"light:c\", c) Ci += c;", {3, 3, 3}},
                 {"illuminance(P) { float d = 0; Ci += lightsource(\"doubled\", d); Ci += d; }", {7, 7, 7}}};
    for (const auto& c : cases) {
        surfaceOf("asks", std::string("    ") + c.body);
        expectEverywhere(scene("LightSource \"tells\" 1 \"float c\" 3\n", "\"asks\""), c.want, c.body);
    }
}

TEST(Illuminance, SentParameters) {
    writeShader("told", R"(light told(float c = 2; color tint = 1; string mode = "plain"; output varying float seen = 0;) {
    illuminate(point "world" (0, 2, 0)) { seen = c; Cl = c * tint; if (mode == "double") Cl *= 2; }
}
)");
    const struct {
        const char* body;
        Color want;
    } cases[] = {
        {"illuminance(P) Ci += Cl;", {2, 2, 2}},
        {"illuminance(P, \"send:light:c\", 5) Ci += Cl;", {5, 5, 5}},
        {"illuminance(P, \"send:light:tint\", color(1, 2, 3), \"send:light:c\", 3) Ci += Cl;", {3, 6, 9}},
        {"illuminance(P, \"send:light:mode\", \"double\") Ci += Cl;", {4, 4, 4}},
        {"illuminance(P, \"send:light:nothing\", 1) Ci += Cl;", {2, 2, 2}},
        {"illuminance(P, \"send:light:tint\", 4) Ci += Cl;", {2, 2, 2}}, // of another size
        {"illuminance(P, \"send:light:c\", 5) Ci += Cl; illuminance(P) Ci += 10 * Cl; illuminance(P, \"send:light:c\", 7) Ci += "
         "100 * Cl;",
         {725, 725, 725}},
        {"float s = 0; illuminance(P, \"send:light:c\", 5, \"light:seen\", s) Ci += s;", {5, 5, 5}},
        {"float s = 0; illuminance(P, \"send:light:c\", 5, \"light:c\", s) Ci += s;", {5, 5, 5}},
        {"string m = \"\"; illuminance(P, \"send:light:mode\", \"double\", \"light:mode\", m) { if (m == \"double\") Ci += 1; }",
         {1, 1, 1}},
        {"illuminance(\"x\", P, \"send:light:c\", 5) Ci += Cl;", {0, 0, 0}}};
    for (const auto& c : cases) {
        surfaceOf("sends", std::string("    ") + c.body);
        expectEverywhere(scene("LightSource \"told\" 1\n", "\"sends\""), c.want, c.body);
    }
    // A value of each point.
    surfaceOf("sendseach", "    illuminance(P, \"send:light:c\", xcomp(transform(\"world\", P))) Ci += Cl;");
    Scene s(scene("LightSource \"told\" 1\n", "\"sendseach\""), under(Hider::Hidden));
    const CameraRay rays[] = {rayTo({1, 2, 0}, {1, 0, 0}), rayTo({3, 2, 0}, {3, 0, 0}), rayTo({.5f, 2, 0}, {.5f, 0, 0})};
    const float want[] = {1, 3, .5f};
    auto r = s.trace(rays);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(r[size_t(k)].color.x, want[k], 1e-4);
}

// How often a light runs is seen by what it prints.
TEST(Illuminance, ResultsAreKept) {
    writeShader("prints",
                "light prints(float c = 2;) { illuminate(point \"world\" (0, 2, 0)) { Cl = c; printf(\"ran\\n\"); } }\n");
    const struct {
        const char* body;
        int runs;
    } cases[] = {{"illuminance(P) Ci += Cl;", 1},
                 {"illuminance(P) Ci += Cl; illuminance(P) Ci += Cl;", 1},
                 {"illuminance(P) Ci += Cl; illuminance(P, normal \"world\" (0, 1, 0), 1) Ci += Cl;", 1},
                 {"Ci = diffuse(normalize(N)) + specular(normalize(N), -normalize(I), .1);", 1},
                 {"illuminance(P) Ci += Cl; illuminance(P, \"lightcache\", \"reuse\") Ci += Cl;", 1},
                 {"illuminance(P) Ci += Cl; illuminance(P, \"lightcache\", \"refresh\") Ci += Cl;", 2},
                 {"illuminance(P) Ci += Cl; illuminance(P + vector(1, 0, 0)) Ci += Cl;", 2},
                 {"illuminance(P) Ci += Cl; illuminance(P, \"send:light:c\", 3) Ci += Cl;", 2},
                 {"illuminance(P, \"send:light:c\", 3) Ci += Cl; illuminance(P, \"send:light:c\", 3) Ci += Cl;", 1},
                 {"illuminance(P) Ci += Cl; N = normal(1, 0, 0); illuminance(P) Ci += Cl;", 2},
                 {"float i; for (i = 0; i < 4; i += 1) illuminance(P) Ci += Cl;", 1}};
    for (const auto& c : cases) {
        surfaceOf("counts", std::string("    ") + c.body);
        Scene s(scene("LightSource \"prints\" 1\n", "\"counts\""), under(Hider::Hidden));
        ::testing::internal::CaptureStdout();
        s.one(kView);
        s.world->flushPrints(true);
        const std::string said = ::testing::internal::GetCapturedStdout();
        int runs = 0;
        for (size_t at = said.find("ran"); at != std::string::npos; at = said.find("ran", at + 1)) ++runs;
        EXPECT_EQ(runs, c.runs) << c.body;
    }
}

// What a light reads of the normal is the shader's, once that has set it.
TEST(Illuminance, TheNormalThatLightsSee) {
    writeShader("seesnormal", "light seesnormal() { illuminate(point \"world\" (0, 2, 0)) { vector n = vtransform(\"world\", "
                              "vector(Ns)); Cl = color(xcomp(n), ycomp(n), zcomp(n)); } }\n");
    surfaceOf("turned", "    N = ntransform(\"world\", \"current\", normal(1, 0, 0)); illuminance(P) Ci += Cl;");
    expectEverywhere(scene("LightSource \"seesnormal\" 1\n", "\"turned\""), {1, 0, 0}, "turned");
}

// A strip that waits inside its loop finds its own light again. Every point asks with another color.
TEST(Illuminance, EachStripHasItsLoop) {
    writeShader("said", "light said(float c = 1;) { illuminate(point \"world\" (0, 2, 0)) Cl = c; }\n");
    writeShader("waits", R"(surface waits() {
    float x = xcomp(transform("world", P)), c = 0;
    Oi = 1; Ci = 0;
    illuminance(P, "send:light:c", x) {
        color t = trace(P, normalize(vector "world" (0, 1, 0)));
        if (comp(t, 0) > .5) Ci += 1000;
        lightsource("c", c);
        Ci += c;
    }
}
)");
    Settings set = under(Hider::Hidden);
    Scene s(scene("LightSource \"said\" 1\nLightSource \"said\" 2\n", "\"waits\""), set);
    std::vector<CameraRay> rays;
    for (int i = 0; i < 300; ++i) rays.push_back(rayTo({float(i) * .1f, 2, 0}, {float(i) * .1f, 0, 0}));
    auto r = s.trace(rays);
    for (int i = 0; i < 300; ++i) EXPECT_NEAR(r[size_t(i)].color.x, 2 * i * .1f, 2e-4 * (1 + i * .1f)) << i;
}

TEST(Illuminance, OutputsOfTheSurfaceAreReadByLights) {
    writeShader("readssurface", R"(light readssurface() {
    illuminate(point "world" (0, 2, 0)) {
        float strength = 1, given = 0; color tint = 1;
        surface("strength", strength); surface("tint", tint); surface("given", given);
        Cl = strength * tint + given;
    }
}
)");
    const struct {
        const char* body;
        Color want;
    } cases[] = {{"illuminance(P) Ci += Cl;", {.5f, .5f, .5f}}, // 0 times tint, and what is given
                 {"strength = 3; tint = color(1, 2, 0); illuminance(P) Ci += Cl;", {3.5f, 6.5f, .5f}},
                 {"strength = 3; illuminance(P) Ci += Cl; strength = 5; illuminance(P) Ci += Cl;", {9, 9, 9}},
                 {"strength = 4; Ci = diffuse(normal \"world\" (0, 1, 0));", {4.5f, 4.5f, 4.5f}},
                 // A shader that waits for a ray: as the outputs are when it asks for light.
                 {"strength = 3; tint = color(1, 2, 0); if (comp(trace(P, vector \"world\" (0, 1, 0)), 0) > 7) strength = 50; "
                  "normal n = normal \"world\" (0, 1, 0);"
                  "Ci = diffuse(n); strength = 5; Ci += diffuse(n);",
                  {9, 17, 1}}};
    for (const auto& c : cases) {
        surfaceOf("isread", std::string("    ") + c.body,
                  "float given = .5; output varying float strength = 0; output varying color tint = 1;");
        std::string rib = scene("LightSource \"readssurface\" 1\n", "\"isread\"");
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(rib, under(h));
            const Color got = s.one(kView);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], c.want[k], 1e-5) << c.body << s.messages();
        }
    }
    // A surface without such outputs leaves the light's own values.
    surfaceOf("isnotread", "    illuminance(P) Ci += Cl;");
    expectEverywhere(scene("LightSource \"readssurface\" 1\n", "\"isnotread\""), Color(1), "without outputs");
}

// A light with an area knows the surface too, however light and surface meet: by a sample, by the lobe's own ray, by trace().
TEST(Illuminance, OutputsAreReadWhereRaysMeetLights) {
    writeShader("readsarea", R"(light readsarea() {
    float strength = 1;
    surface("strength", strength);
    illuminate(P, N, PI / 2) Cl = strength;
}
)");
    const std::string disk = "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"readsarea\" "
                             "7\nSurface \"constant\"\nColor 0 0 0\n"
                             "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
    const char* kUp = "normal n = normal \"world\" (0, 1, 0); ";
    const struct {
        const char *body, *what;
    } cases[] = {
        {"strength = 4; Ci = diffuse(n);", "summed up"},
        {"strength = 4; if (comp(trace(P, -n), 0) > 7) strength = 50; Ci = diffuse(n);", "waiting"},
        {"strength = 4; Ci = trace(P, n, \"distribution\", \"cosine\", \"samplecone\", PI / 2, \"samplearealights\", 1);",
         "trace"}};
    for (const auto& c : cases) {
        surfaceOf("isreadbyarea", std::string("    ") + kUp + c.body, "output varying float strength = 0;");
        for (int way = 0; way < 3; ++way) {
            Settings set = under(Hider::Path);
            set.bsdfOnly = way == 1;
            set.lightOnly = way == 2;
            Scene s(scene(disk, "\"isreadbyarea\""), set);
            expectMean(s.estimate(kView, samples(6000)), 4 * .49 / 4.49, way == 1 ? .05 : .015,
                       c.what + std::string(way == 0   ? ""
                                            : way == 1 ? ", rays"
                                                       : ", samples"));
        }
    }
}

// handle->light() asks all samples of a light: what it gives is the light of the whole of it, with less noise.
TEST(LightHandles, LightOfAllSamples) {
    writeShader("halfdark", "light halfdark() { illuminate(P, N, PI / 2) Cl = xcomp(transform(\"world\", P)) > 0 ? 8 : 0; }\n");
    surfaceOf("byhandle", R"(    shader all[] = getlights();
    vector l = 0; color c = 0;
    all[0]->light(l, c);
    Ci = c * max(0, normalize(-l) . normal "world" (0, 1, 0));)");
    auto with = [&](int n) {
        const std::string disk =
            "AttributeBegin\nAttribute \"light\" \"integer samples\" [" + std::to_string(n) +
            "]\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"halfdark\" 7\nSurface \"constant\"\n"
            "Color 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
        return Scene(scene(disk, "\"byhandle\""), under(Hider::Hidden)).estimate(kView, samples(6000));
    };
    const auto one = with(1), nine = with(9);
    expectMean(one, 4 * .49 / 4.49, .03, "one sample");
    expectMean(nine, 4 * .49 / 4.49, .015, "nine samples");
    EXPECT_LT(nine.se(), one.se() * .5); // a third, but for the order of sequences
}

TEST(Illuminance, CoShadersLoopOverLights) {
    writeLights();
    writeShader("looplayer", R"(class looplayer(float gain = 1;) {
    public void add(output color c; string cat) { extern point P; illuminance(cat, P) { c += gain * Cl; } }
}
)");
    surfaceOf("loops", "    shader l = getshader(\"layer\"); l->add(Ci, \"a\"); l->add(Ci, \"-a\");");
    const std::string rib = "WorldBegin\nSides 2\n" + flat(1, 1, 2, category("a")) + flat(2, 4, 3, category("b")) +
                            "Shader \"looplayer\" \"layer\" \"float gain\" 3\nSurface \"loops\"\n" + kFloor + "WorldEnd\n";
    expectEverywhere(rib, Color(15), "co-shader");
}

TEST(Illuminance, SamplesOfAnAreaLightAreTurns) {
    surfaceOf("turns", "    illuminance(P) Ci += 1;");
    const std::string disk = "AttributeBegin\nAttribute \"light\" \"integer samples\" [6]\nAttribute \"light\" \"string units\" "
                             "\"radiance\" AreaLightSource \"slrect\" 7\nSurface \"constant\"\nColor 0 0 0\n"
                             "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
    Scene s(scene(disk, "\"turns\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, 6, 1e-5);
}

TEST(LightWeights, NonDiffuseAndNonSpecular) {
    writeLights();
    // The light shines along the normal, and so does the eye look: every lobe is 1 there.
    const CameraRay straight = rayTo({0, .8f, 0}, {0, 0, 0});
    const struct {
        const char* body;
        bool diffuse;
    } cases[] = {{"Ci = diffuse(normalize(faceforward(N, I)));", true},
                 {"Ci = specularstd(normalize(faceforward(N, I)), -normalize(I), .1);", false},
                 {"Ci = phong(normalize(faceforward(N, I)), -normalize(I), 10);", false},
                 {"Ci = specular(normalize(faceforward(N, I)), -normalize(I), .1);", false}};
    for (const auto& c : cases)
        for (float w : {0.f, .25f, 1.f}) {
            surfaceOf("weighs", std::string("    ") + c.body);
            const std::string weight =
                std::string("\"float __non") + (c.diffuse ? "diffuse" : "specular") + "\" " + std::to_string(w);
            const std::string other = std::string("\"float __non") + (c.diffuse ? "specular" : "diffuse") + "\" 1";
            const double want = 8 * (1 - w);
            Scene hidden(scene(flat(1, 8, 2, weight + " " + other), "\"weighs\""), under(Hider::Hidden));
            EXPECT_NEAR(hidden.one(straight).x, want, 1e-4) << c.body << w;
            Scene path(scene(flat(1, 8, 2, weight + " " + other), "\"weighs\""), under(Hider::Path));
            EXPECT_NEAR(path.one(straight).x, want, 1e-4) << c.body << w;
        }
}

// Emitters that a lobe's own ray meets are weighed like those that it samples: L R^2 / (R^2 + h^2) in all three ways.
TEST(LightWeights, OfEmittersMetByRays) {
    writeShader("weighedarea", "light weighedarea(float __nondiffuse = .75;) { illuminate(P, N, PI / 2) Cl = 5; }\n");
    const std::string disk = "AttributeBegin\nAttribute \"light\" \"string units\" \"radiance\" AreaLightSource \"weighedarea\" "
                             "7\nSurface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\n"
                             "AttributeEnd\nIlluminate 7 1\n";
    for (int mode : {0, 1, 2}) {
        Settings set = under(Hider::Path);
        set.bsdfOnly = mode == 1;
        set.lightOnly = mode == 2;
        Scene s(scene(disk, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), set);
        expectMean(s.estimate(kView, samples(mode == 1 ? 200000 : 20000)), .25 * 5 * .49 / 4.49, .02,
                   "mode " + std::to_string(mode));
    }
    writeShader("weighedsky", "light weighedsky(float __nondiffuse = .75;) { solar() Cl = 4; }\n");
    Scene sky(scene("LightSource \"weighedsky\" 1\n", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"), under(Hider::Path));
    expectMean(sky.estimate(kView, samples(2000)), 1, .02, "sky");
}

// solar(axis, angle): one direction without an angle; under path, directions of the cone. L of a sky is where its light goes.
TEST(Solar, ConeOfDirections) {
    writeShader("sun", "light sun(float angle = 0;) { solar(vector \"world\" (0, -1, 0), angle) Cl = 2; }\n");
    surfaceOf("meancosine", "    illuminance(P) Ci += Cl * (normalize(L) . normalize(vector \"world\" (0, 1, 0)));");
    const double half = .6; // the mean cosine over a cone is (1 + cos a) / 2
    Scene sharp(scene("LightSource \"sun\" 1\n", "\"meancosine\""), under(Hider::Path));
    EXPECT_NEAR(sharp.one(kView).x, 2, 1e-5);
    Scene hidden(scene("LightSource \"sun\" 1 \"float angle\" .6\n", "\"meancosine\""), under(Hider::Hidden));
    EXPECT_NEAR(hidden.one(kView).x, 2, 1e-5);
    for (const char* look : {"\"meancosine\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"})
        for (const char* count : {"", "Attribute \"light\" \"integer samples\" [3]\n"}) {
            Scene soft(scene(count + std::string("LightSource \"sun\" 1 \"float angle\" .6\n"), look), under(Hider::Path));
            expectMean(soft.estimate(kView, samples(4000)), 1 + std::cos(half), .01, look);
        }
    // A half plane that hides half of the cone takes half of its light.
    const std::string wall = "AttributeBegin\nSurface \"constant\"\nColor 0 0 0\nPolygon \"P\" [0 .5 -90  90 .5 -90  90 .5 90  0 "
                             ".5 90]\nAttributeEnd\n";
    Scene shaded(scene("LightSource \"sun\" 1 \"float angle\" .6\n" + wall, "\"matte\" \"float Ka\" 0 \"float Kd\" 1"),
                 under(Hider::Path));
    expectMean(shaded.estimate(rayTo({-.3f, .2f, -.4f}, {0, 0, 0}), samples(20000)), (1 + std::cos(half)) / 2, .02, "half");
}
TEST(Solar, TheSkyKnowsItsDirection) {
    writeShader(
        "upsky",
        "light upsky() { solar() { vector d = normalize(vtransform(\"world\", L)); Cl = -ycomp(d); } }\n"); // cosine above
    surfaceOf("skyloop", "    illuminance(P, normal \"world\" (0, 1, 0), PI / 2) Ci += Cl * (normalize(L) . normalize(vector "
                         "\"world\" (0, 1, 0)));");
    // Mean of cos^2 over the hemisphere by 1 / pi: 2 pi / 3 / pi.
    for (const char* look : {"\"skyloop\"", "\"matte\" \"float Ka\" 0 \"float Kd\" 1"}) {
        Scene s(scene("LightSource \"upsky\" 1\n", look), under(Hider::Path));
        expectMean(s.estimate(kView, samples(20000)), 2 / 3.0, .01, look);
    }
}

// Without rays a sky is one light that faces the surface: diffuse() gets from it what an even sky gives, from either side.
TEST(Solar, WithoutRaysTheSkyFacesTheSurface) {
    writeShader("evensky", "light evensky() { solar() Cl = color(2, .5, .25); }\n");
    surfaceOf(
        "onelight",
        "    illuminance(P, faceforward(normalize(N), I), PI / 2) Ci += Cl * (normalize(L) . faceforward(normalize(N), I));");
    surfaceOf("anylight",
              "    shader all[] = getlights(); illuminance(P) Ci += Cl * arraylength(all) * abs(normalize(L) . normalize(N));");
    for (const char* look : {"\"matte\" \"float Ka\" 0 \"float Kd\" 1", "\"onelight\"", "\"anylight\""})
        for (const char* attribute : {"", "Attribute \"light\" \"integer samples\" [4]\n"}) {
            Scene s(scene(attribute + std::string("LightSource \"evensky\" 1\n"), look), under(Hider::Hidden));
            const Color c = s.one(kView);
            EXPECT_NEAR(c.x, 2, 1e-5) << look;
            EXPECT_NEAR(c.y, .5, 1e-5) << look;
            EXPECT_NEAR(c.z, .25, 1e-5) << look;
        }
}

TEST(LightHandles, LoopsByHand) {
    writeLights();
    const std::string lights = flat(1, 1, 2, category("a")) + flat(2, 4, 3, category("b")) + flat(3, 16, 5, category("a,b"));
    const struct {
        const char* body;
        float want;
    } cases[] = {{"shader l[] = getlights(); Ci = arraylength(l);", 3},
                 {"shader l[] = getlights(\"category\", \"a\"); Ci = arraylength(l);", 2},
                 {"shader l[] = getlights(\"category\", \"a&-b\"); Ci = arraylength(l);", 1},
                 {"shader l[] = getlights(\"category\", \"none\"); Ci = arraylength(l);", 0},
                 {"vector D; color C; shader l[] = getlights(); float i; for (i = 0; i < arraylength(l); i += 1) { "
                  "l[i]->light(D, C); Ci += C; }",
                  21},
                 {"vector D; color C; shader l[] = getlights(\"category\", \"a\"); uniform float n = arraylength(l), i; for (i = "
                  "0; i < n; i += 1) "
                  "{ l[i]->light(D, C); Ci += C * (vector \"world\" (0, 1, 0) . normalize(-D)); }",
                  17},
                 {"vector D; color C; getlight(\"2\")->light(D, C); Ci = length(D);", 3},
                 {"vector D = 7; color C = 5; shader s = getlight(\"9\"); s->light(D, C); Ci = C;", 5},
                 {"shader s = getlight(\"3\"); Ci = s->h;", 5},
                 {"float v = 0; shader s = getlight(\"2\"); Ci = 10 * getvar(s, \"c\", v); Ci += v;", 14},
                 {"float v = 3; shader s = getlight(\"2\"); Ci = 10 * getvar(s, \"nothing\", v); Ci += v;", 3},
                 {"illuminance(P) Ci += islightcategory(\"a\") * Cl;", 17},
                 {"illuminance(P) Ci += islightcategory(\"a&b\") * Cl;", 16}};
    for (const auto& c : cases) {
        surfaceOf("byhand", std::string("    ") + c.body);
        expectEverywhere(scene(lights, "\"byhand\""), Color(c.want), c.body);
    }
}
// The limit of handles: the rest is left out, and said.
TEST(LightHandles, NoMoreThanTheLimit) {
    writeLights();
    std::string lights;
    for (int i = 0; i < limits::kLightHandles + 3; ++i) lights += flat(i + 1, 1);
    surfaceOf("many", "    shader l[] = getlights(); Ci = arraylength(l);");
    Scene s(scene(lights, "\"many\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, limits::kLightHandles, 1e-4);
    EXPECT_NE(s.messages().find("getlights() returns at most"), std::string::npos) << s.messages();
}
// More light samples than are kept for the next loop: those that are not kept are taken anew, and the sum is the same.
TEST(Illuminance, MoreLightsThanAreKept) {
    writeLights();
    std::string lights;
    const int count = int(limits::kLightCache) + 20;
    for (int i = 0; i < count; ++i) lights += flat(i + 1, 1);
    surfaceOf("twice", "    illuminance(P) Ci += Cl; illuminance(P) Ci += 2 * Cl;");
    Scene s(scene(lights, "\"twice\""), under(Hider::Hidden));
    EXPECT_NEAR(s.one(kView).x, 3 * count, 1e-2);
}
// Lights with several samples give as many turns, and the kept samples are those of the first loop: a difference of two loops is
// nothing.
TEST(Illuminance, SamplesAreKeptOneByOne) {
    surfaceOf("difference", "    color a = 0, b = 0; illuminance(P) { a += Cl * length(L); } illuminance(P) { b += Cl * "
                            "length(L); } Ci = abs(comp(a - b, 0)); Ci += a;");
    const std::string disk = "AttributeBegin\nAttribute \"light\" \"integer samples\" [5]\nAttribute \"light\" \"string units\" "
                             "\"radiance\" AreaLightSource \"slrect\" 7\nSurface \"constant\"\nColor 0 0 0\n"
                             "Translate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
    surfaceOf("samesum", "    illuminance(P) { Ci += Cl * length(L); }");
    Scene one(scene(disk, "\"samesum\""), under(Hider::Hidden)), two(scene(disk, "\"difference\""), under(Hider::Hidden));
    const float want = one.one(kView).x;
    EXPECT_GT(want, 0);
    EXPECT_EQ(two.one(kView).x, want);
}
// What does not fit is said where it stands.
TEST(Illuminance, PairsThatMeanNothingAreSaid) {
    writeLights();
    const struct {
        const char* body;
        const char* said;
    } cases[] = {{"illuminance(P, \"lightcache\", \"maybe\") Ci += Cl;", "\"reuse\" or \"refresh\""},
                 {"illuminance(P, \"shadow\", 1) Ci += Cl;", "means nothing to illuminance"},
                 {"string a[2] = {\"x\", \"y\"}; illuminance(P, \"send:light:c\", a) Ci += Cl;", "it is not sent"},
                 {"string s = format(\"%f\", xcomp(P)); illuminance(P, \"send:light:mode\", s) Ci += Cl;", "it is not sent"},
                 {"Ci = 1 + islightcategory(\"a\");", "there is none here"}};
    for (const auto& c : cases) {
        surfaceOf("unfit", std::string("    ") + c.body);
        Scene s(scene(flat(1, 1), "\"unfit\""), under(Hider::Hidden));
        EXPECT_NEAR(s.one(kView).x, 1, 1e-5) << c.body;
        EXPECT_NE(s.messages().find(c.said), std::string::npos) << c.body << s.messages();
    }
}

// Under path the light that a handle gives has its shadow.
TEST(LightHandles, CastShadows) {
    writeLights();
    surfaceOf("shadowed", "    vector D; color C; shader l[] = getlights(); float i; for (i = 0; i < arraylength(l); i += 1) { "
                          "l[i]->light(D, C); Ci += C; }");
    const std::string roof =
        "AttributeBegin\nSurface \"constant\"\nPolygon \"P\" [-1 1 -1  1 1 -1  1 1 1  -1 1 1]\nAttributeEnd\n";
    Scene s(scene(flat(1, 1) + flat(2, 4, .5f) + roof, "\"shadowed\""), under(Hider::Path));
    EXPECT_NEAR(s.one(kView).x, 4, 1e-5);
}

} // namespace

} // namespace lightloop_test

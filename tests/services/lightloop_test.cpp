// illuminance in all its forms. A large floor y = 0 seen at the origin; a point light of intensity I
// at height h straight above gives Cl = I / h^2 there, L = (0, h, 0). Under path the same, for nothing lies between.
#include "base/limits.h"
#include "services/lightloopscene.h"

namespace lightloop_test {

namespace {
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

} // namespace

} // namespace lightloop_test

// What shaders ask in rendered scenes: volumes on both sides, attributes that nobody has set, labels of rays, BMRT's shadeops,
// samples and shadows of area lights.
#include "integrator/floorscene.h"

namespace information_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

// From outside the incident side is the exterior, from inside the interior; a second sphere of the same surface has its own
// volumes.
TEST(Information, IncidentAndOpposite) {
    writeShader("thick", "volume thick(float density = 1;) { Ci = Ci; Oi = Oi; }\n");
    writeShader("sides", "surface sides() { float a = -1, b = -1; incident(\"density\", a); opposite(\"density\", b); Oi = 1; Ci "
                         "= color(a, b, 0); }\n");
    auto ball = [](const char* x, const char* in, const char* out) {
        return std::string("AttributeBegin\nInterior \"thick\" \"density\" ") + in + "\nExterior \"thick\" \"density\" " + out +
               "\nTranslate " + x + " 0 4\nSphere 1 -1 1 360\nAttributeEnd\n";
    };
    Scene s(inWorld("Surface \"sides\"\n" + ball("-2", "3", "5") + ball("2", "7", "9")), under(Hider::Hidden));
    const CameraRay rays[] = {rayTo({-2, 0, 0}, {-2, 0, 4}), rayTo({2, 0, 0}, {2, 0, 4}), rayTo({-2, 0, 4}, {-2, 0, 9})};
    const auto r = s.trace(rays);
    EXPECT_EQ(r[0].color, Color(5, 3, 0));
    EXPECT_EQ(r[1].color, Color(9, 7, 0));
    EXPECT_EQ(r[2].color, Color(3, 5, 0));
}
// Nothing is there to tell: the variables stay.
TEST(Information, NoVolumes) {
    writeShader("sides", "surface sides() { float a = -1, b = -1; incident(\"density\", a); opposite(\"density\", b); Oi = 1; Ci "
                         "= color(a, b, 0); }\n");
    Scene s(inWorld(std::string("Surface \"sides\"\n") + kFloor), under(Hider::Hidden));
    EXPECT_EQ(s.one(kView), Color(-1, -1, 0));
}
TEST(Information, AttributesAsTheyAreWhenUnset) {
    writeShader("asks", R"(surface asks(string what = "";) {
    float v = -1;
    float found = attribute(what, v);
    Oi = 1;
    Ci = color(found, v, 0);
}
)");
    struct Row {
        const char* name;
        float found, hidden, path;
    };
    for (const Row& r : {Row{"Ri:ShadingRate", 1, 1, 1}, Row{"trace:maxdiffusedepth", 1, 1, 32},
                         Row{"trace:maxspeculardepth", 1, 2, 32}, Row{"trace:bias", 1, -1, -1},
                         Row{"visibility:diffuse", 1, 0, 1}, Row{"light:samples", 1, 1, 1}, Row{"user:nobody", 0, -1, -1}})
        for (Hider h : {Hider::Hidden, Hider::Path}) {
            Scene s(inWorld("Surface \"asks\" \"what\" \"" + std::string(r.name) + "\"\n" + kFloor), under(h));
            EXPECT_EQ(s.one(kView), Color(r.found, h == Hider::Path ? r.path : r.hidden, 0)) << r.name;
        }
    writeShader("asksunits", "surface asksunits() { string v = \"?\"; float found = attribute(\"light:units\", v); Oi = 1; Ci = "
                             "color(found, v == \"radiance\", v == \"samples\"); }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) // what an area light would give
        EXPECT_EQ(Scene(inWorld(std::string("Surface \"asksunits\"\n") + kFloor), under(h)).one(kView),
                  h == Hider::Path ? Color(1, 1, 0) : Color(1, 0, 1));
    Scene given(
        inWorld(std::string("Attribute \"user\" \"uniform float nobody\" 4\nSurface \"asks\" \"what\" \"user:nobody\"\n") +
                kFloor),
        under(Hider::Hidden));
    EXPECT_EQ(given.one(kView), Color(1, 4, 0));
}
// 0 at the near plane, 1 at the far one, whatever the hider.
TEST(Information, DepthBetweenThePlanesOfClipping) {
    writeShader("deep", "surface deep() { Oi = 1; Ci = depth(P); }\n");
    for (Hider h : {Hider::Hidden, Hider::Raytrace}) {
        Scene s("Clipping 1 11\n" + inWorld("Surface \"deep\"\nPolygon \"P\" [-9 -9 3  -9 9 3  9 9 3  9 -9 3]\n"), under(h));
        EXPECT_NEAR(s.one(rayTo({0, 0, 1}, {.1f, 0, 3})).x, .2, 1e-6);
    }
}
// Strings that are joined with themselves end at a length, with a word.
TEST(Information, StringsDoNotDoubleForEver) {
    writeShader("doubles", "surface doubles(string start = \"xy\";) { string a = start; float i; for (i = 0; i < 200; i += 1) a "
                           "+= a; Oi = 1; Ci = a == start ? 0 : 1; }\n");
    Scene s(inWorld(std::string("Surface \"doubles\"\n") + kFloor), under(Hider::Hidden));
    EXPECT_EQ(s.one(kView), Color(1, 1, 1));
    EXPECT_NE(s.messages().find("65536 characters"), std::string::npos);
}
// surface() within the method of that name asks the shader, which is itself.
TEST(Information, AMethodAsksItsOwnShader) {
    writeShader("asksown", "class asksown(float Kd = .5;) { public void surface(output color Ci, Oi) { float k = 0; float found "
                           "= surface(\"Kd\", k); Ci = color(found, k, 0); Oi = 1; } }\n");
    Scene s(inWorld(std::string("Surface \"asksown\" \"Kd\" .25\n") + kFloor), under(Hider::Hidden));
    EXPECT_EQ(s.one(kView), Color(1, .25f, 0));
}
// A ray's label reaches the shader that it meets; the camera's have none.
TEST(Information, LabelsOfRays) {
    writeShader("labelled", "surface labelled() { string l = \"?\"; rayinfo(\"label\", l); Oi = 1; Ci = l == \"probe\" ? 1 : l "
                            "== \"other\" ? .5 : l == \"\" ? .25 : 0; }\n");
    writeShader("labels", R"(surface labels() {
    color a = trace(P, vector(0, 1, 0), "label", "probe"), b = trace(P, vector(0, 1, 0), "raylabel", "other"),
        c = trace(P, vector(0, 1, 0));
    Oi = 1;
    Ci = color(comp(a, 0), comp(b, 0), comp(c, 0));
}
)");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"labelled\"\nPolygon \"P\" [-9 1 -9 "
                             " -9 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    for (Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld(card + "Surface \"labels\"\n" + kFloor), under(h));
        EXPECT_EQ(s.one(kView), Color(1, .5f, .25f));
        EXPECT_EQ(s.one(rayTo({0, 3, 0}, {0, 1, 0})), Color(.25f));
    }
}
// raylabel() of Pixie: "camera" for rays of the camera.
TEST(Information, CameraRaysHaveALabelInPixie) {
    writeShader("labelword",
                "surface labelword() { string l = raylabel(); Oi = 1; Ci = l == \"camera\" ? 1 : l == \"probe\" ? .5 : l "
                "== \"\" ? .25 : 0; }\n");
    writeShader("asksword",
                "surface asksword() { color a = trace(P, vector(0, 1, 0), \"label\", \"probe\"), b = trace(P, vector(0, "
                "1, 0)); Oi = 1; Ci = color(comp(a, 0), comp(b, 0), 0); }\n");
    const std::string card =
        "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nSurface \"labelword\"\nPolygon \"P\" [-9 1 -9 "
        " -9 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    EXPECT_EQ(Scene(inWorld(std::string("Surface \"labelword\"\n") + kFloor), under(Hider::Hidden)).one(kView), Color(1, 1, 1));
    for (Hider h : {Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld(card + "Surface \"asksword\"\n" + kFloor), under(h));
        EXPECT_EQ(s.one(kView), Color(.5f, .25f, 0));
        EXPECT_EQ(s.one(rayTo({0, 3, 0}, {0, 1, 0})), Color(1, 1, 1));
    }
}
// BMRT's: a card of colour (.5, .25, 1) two above the floor, whose normal points down to it.
TEST(Information, RaysOfBmrt) {
    writeShader("bmrtfull", R"(surface bmrtfull(float up = 1;) {
    color hitcolor = 0;
    float hitdist = 0;
    point Phit = 0, Pmiss = 0;
    vector Nhit = 0, Rmiss = 0;
    float hit = fulltrace(P, vector(0, up, 0), hitcolor, hitdist, Phit, Nhit, Pmiss, Rmiss);
    Oi = 1;
    Ci = hit > 0 ? hitcolor + color(hitdist, ycomp(Phit), abs(ycomp(normalize(Nhit))))
                 : color(ycomp(Rmiss), distance(Pmiss, P), -1);
}
)");
    writeShader("bmrthit", R"(surface bmrthit() {
    point Ph = 0;
    vector Nh = 0;
    Oi = 1;
    Ci = color(rayhittest(P, vector(0, 3, 0), Ph, Nh), ycomp(Ph), abs(ycomp(normalize(Nh))));
}
)");
    writeShader(
        "bmrtsees",
        "surface bmrtsees() { Oi = 1; Ci = visibility(P, P + vector(0, 1, 0)) + .5 * visibility(P, P + vector(0, 3, 0)); }\n");
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"trace\" 1\nAttribute \"visibility\" \"transmission\" "
                             "1\nSurface \"constant\"\nColor .5 .25 1\n"
                             "Polygon \"P\" [-9 2 -9  -9 2 9  9 2 9  9 2 -9]\nAttributeEnd\n";
    // Pixie's float: the mean of what is left of the colours behind a film of opacity (.6, .3, .9).
    writeShader("pixiesees", "surface pixiesees() { Oi = 1; float a = visibility(P, P + vector(0, 1, 0)), b = visibility(P, P + "
                             "vector(0, 3, 0)); Ci = color(a, b, 0); }\n");
    auto of = [&](const std::string& surface, const std::string& film = "") {
        return Scene(inWorld(film + card + "Surface " + surface + "\n" + kFloor), under(Hider::Raytrace)).one(kView);
    };
    auto near = [](const Color& c, const Color& want, const char* what) {
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], 1e-4) << what << " " << k;
    };
    near(of("\"bmrtfull\""), Color(2.5f, 2.25f, 2), "fulltrace");
    near(of("\"bmrtfull\" \"up\" -1"), Color(-1, 0, -1), "fulltrace that meets nothing");
    near(of("\"bmrthit\""), Color(2, 2, 1), "rayhittest");
    near(of("\"bmrtsees\""), Color(1), "visibility");
    near(of("\"pixiesees\"", "Opacity .6 .3 .9\n"), Color(1, .4f, 0), "visibility as a float");
}
// A light's outputchannel() is an output of the surface: of what the light found there; "light:" keeps it to itself. Not where
// the surface has that output.
TEST(Information, OutputsOfLights) {
    writeShader("tells", R"(light tells(point from = point "world" (0, 2, 0);) {
    illuminate(from) {
        Cl = 4 / (L . L);
        outputchannel("far", length(L));
        outputchannel("tint", color(1, 2, 3) * Cl);
        outputchannel("light:mine", 5.0);
    }
}
)");
    writeShader("own", "surface own(output varying float far = 0;) { far = 7; Oi = 1; Ci = diffuse(N); }\n");
    auto aovs = [&](Hider h, const char* surface) {
        Settings set = under(h);
        set.outputs = {"far", "tint", "mine"};
        Scene s(inWorld("LightSource \"tells\" 1\nSurface \"" + std::string(surface) + "\"\n" + kFloor), set);
        EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
        return s.trace(std::vector<CameraRay>{kView})[0].aovs;
    };
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const auto a = aovs(h, "matte");
        ASSERT_EQ(a.size(), 5u); // as many as the lights give
        EXPECT_NEAR(a[0], 2, 1e-5);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[size_t(1 + k)], 1 + k, 1e-5);
        EXPECT_EQ(a[4], 0);
        EXPECT_NEAR(aovs(h, "own")[0], 7, 1e-5);
    }
}
// Arrays go to lights and come back from them: 1 + 2 + 3 is what the light was given, 10 + 20 + 3 when two numbers are sent; each
// point sends its own.
TEST(Information, ArraysOfLights) {
    writeShader("weights",
                "light weights(float w[3] = {1, 2, 3};) { illuminate(point \"world\" (0, 2, 0)) Cl = w[0] + w[1] + w[2]; }\n");
    writeShader("sends", R"(surface sends(float send = 1;) {
    float two[2] = {10, 20}, got[3] = {0, 0, 0};
    if (xcomp(transform("world", P)) > 0) two[0] = 50;
    color c = 0;
    if (send > 0) { illuminance(P, "send:light:w", two, "light:w", got) c += Cl; }
    else { illuminance(P, "light:w", got) c += Cl; }
    Oi = 1;
    Ci = color(comp(c, 0), got[0], got[2]);
}
)");
    auto of = [&](const std::string& surface) {
        return Scene(inWorld("LightSource \"weights\" 1\nSurface " + surface + "\n" + kFloor), under(Hider::Hidden));
    };
    EXPECT_EQ(of("\"sends\" \"send\" 0").one(kView), Color(6, 1, 3));
    Scene s = of("\"sends\"");
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    const CameraRay both[] = {rayTo({-1, 2, 0}, {-1, 0, .1f}), rayTo({1, 2, 0}, {1, 0, .1f})};
    const auto r = s.trace(both);
    EXPECT_EQ(r[0].color, Color(33, 10, 3));
    EXPECT_EQ(r[1].color, Color(73, 50, 3));
}
// Two numbers are no colour, and four points more than an array of three colours takes.
TEST(Information, ArraysGoToArraysOfTheirClass) {
    writeShader("classes", "light classes(color one = 1; color three[3] = {1, 2, 3};) { illuminate(point \"world\" (0, 2, 0)) Cl "
                           "= one + three[0] + three[1] + three[2]; }\n");
    writeShader("sendsother", R"(surface sendsother() {
    float two[2] = {10, 20};
    color four[4] = {color(4), color(5), color(6), color(7)};
    color back[3] = {0, 0, 0};
    Oi = 1;
    illuminance(P, "send:light:one", two, "send:light:three", four, "light:three", back) Ci += Cl + 100 * back[2];
}
)");
    EXPECT_EQ(Scene(inWorld(std::string("LightSource \"classes\" 1\nSurface \"sendsother\"\n") + kFloor), under(Hider::Hidden))
                  .one(kView),
              Color(616));
}
const char* kDisk =
    "Surface \"constant\"\nColor 0 0 0\nTranslate 0 2 0\nRotate 90 1 0 0\nDisk 0 .7 360\nAttributeEnd\nIlluminate 7 1\n";
std::string disk(const std::string& attributes) {
    writeShader("shine", "light shine() { illuminate(P, N, PI / 2) Cl = 5; }\n");
    return "AttributeBegin\n" + attributes + "Attribute \"light\" \"string units\" \"radiance\" AreaLightSource \"shine\" 7\n" +
           kDisk;
}
// As many turns of the loop as the light has samples, by either name; together they are the light.
TEST(Information, SamplesOfAreaLights) {
    writeShader("turns", "surface turns() { float n = 0; illuminance(P, N, PI) n += 1; Oi = 1; Ci = n / 8; }\n");
    writeShader("sums", "surface sums() { normal Nf = faceforward(normalize(N), I); color c = 0; illuminance(P, Nf, PI / 2) c += "
                        "Cl * (normalize(L) . Nf); Oi = 1; Ci = c; }\n");
    for (const char* name : {"samples", "nsamples"}) {
        const std::string attribute = std::string("Attribute \"light\" \"integer ") + name + "\" 5\n";
        EXPECT_EQ(Scene(inWorld(disk(attribute) + "Surface \"turns\"\n" + kFloor), under(Hider::Hidden)).one(kView).x, 5 / 8.f)
            << name;
        expectMean(
            Scene(inWorld(disk(attribute) + "Surface \"sums\"\n" + kFloor), under(Hider::Hidden)).estimate(kView, samples(4000)),
            5 * .49 / 4.49, .01, name);
    }
    EXPECT_EQ(Scene(inWorld(disk("") + "Surface \"turns\"\n" + kFloor), under(Hider::Hidden)).one(kView).x, 1 / 8.f);
}
// Outside of path an area light is shadowed where its attribute says so.
TEST(Information, ShadowsOfAreaLights) {
    const std::string card = "AttributeBegin\nAttribute \"visibility\" \"transmission\" 1\nSurface \"constant\"\nPolygon \"P\" "
                             "[-9 1 -9  -9 1 9  9 1 9  9 1 -9]\nAttributeEnd\n";
    const std::string floor = std::string("Surface \"matte\" \"Ka\" 0 \"Kd\" 1\n") + kFloor;
    const double want = 5 * .49 / 4.49;
    expectMean(Scene(inWorld(disk("") + card + floor), under(Hider::Hidden)).estimate(kView, samples(4000)), want, .01,
               "without");
    EXPECT_EQ(Scene(inWorld(disk("Attribute \"light\" \"string shadows\" \"on\"\n") + card + floor), under(Hider::Hidden))
                  .estimate(kView, 300)
                  .mean(),
              0);
    expectMean(Scene(inWorld(disk("Attribute \"light\" \"string shadows\" \"on\"\n") + floor), under(Hider::Hidden))
                   .estimate(kView, samples(4000)),
               want, .01, "nothing in the way");
    expectMean(Scene(inWorld(disk("Attribute \"light\" \"string shadows\" \"off\"\n") + card + floor), under(Hider::Hidden))
                   .estimate(kView, samples(4000)),
               want, .01, "off");
}
// The shipped lights have no parameter __category, as few of the old ones have; the scene's word counts all the same.
TEST(Information, CategoriesOfLightsWithoutTheParameter) {
    writeShader("bycategory",
                "surface bycategory() { color key = 0, other = 0, all = 0; Oi = 1; illuminance(\"key\", P) key += Cl;"
                " illuminance(\"-key\", P) other += Cl; illuminance(P) all += Cl; Ci = color(key[0], other[0], all[0]); }\n");
    const std::string down = " \"from\" [0 1 0] \"to\" [0 0 0] \"string __category\" ";
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        Scene s(inWorld("LightSource \"distantlight\" 1 \"intensity\" .25" + down +
                        "[\"warm,key\"]\nLightSource \"distantlight\" 2 \"intensity\" .5" + down +
                        "\"fill\"\nLightSource \"distantlight\" 3 \"intensity\" 2 \"from\" [0 1 0] \"to\" [0 0 0]\nSurface "
                        "\"bycategory\"\n" +
                        kFloor),
                withShaders(h));
        EXPECT_EQ(s.one(kView), Color(.25f, 2.5f, 2.75f));
        EXPECT_EQ(s.messages(), "");
    }
}

} // namespace

} // namespace information_test

// Whom rays meet: "subset", "hitsides", "hitmode", "bias", "maxdist", "label" of trace() and transmission(), the rays of
// environment("raytrace") and shadow("raytrace"), and trace() in lights. Panes over a floor whose shader looks straight up.
#include "integrator/floorscene.h"
#include "integrator/maps.h"

namespace raysets_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

/// Meets the floor from below the lowest pane.
const CameraRay kLow = rayTo({.3f, .4f, -.4f}, {0, 0, 0});

std::string pane(float height, const std::string& attributes, bool turned = false) {
    const std::string h = std::to_string(height);
    const std::string P = turned ? "[9 " + h + " -9  9 " + h + " 9  -9 " + h + " 9  -9 " + h + " -9]"
                                 : "[-9 " + h + " -9  -9 " + h + " 9  9 " + h + " 9  9 " + h + " -9]";
    return "AttributeBegin Surface \"constant\" " + attributes + " Polygon \"P\" " + P + " AttributeEnd\n";
}

/// What the floor shows whose shader gives Ci the expression; `up` is straight up, `far` a point there.
Color shows(const std::string& name, const std::string& expression, const std::string& others, Hider hider = Hider::Raytrace,
            const std::string& floor = "") {
    writeShader(name, "surface " + name + "() { vector up = vector \"world\" (0, 1, 0); point far = P + 50 * up; Oi = 1; " +
                          expression + " }\n");
    Scene s(inWorld("AttributeBegin " + floor + " Surface \"" + name + "\" " + kFloor + "AttributeEnd\n" + others),
            withShaders(hider));
    return s.one(kLow);
}

void expectColor(const Color& c, const Color& want, const std::string& what, float error = 1e-5f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], error) << what << ", channel " << k;
}

const std::string kThree = pane(1, "Attribute \"grouping\" \"membership\" \"a\" Color 1 0 0") +
                           pane(2, "Attribute \"grouping\" \"membership\" \"a,b\" Color 0 1 0") + pane(3, "Color 0 0 1");

TEST(RaySets, Subsets) {
    const std::pair<const char*, Color> cases[] = {
        {"\"subset\", \"\"", {1, 0, 0}},         {"\"subset\", \"a\"", {1, 0, 0}},    {"\"subset\", \"b\"", {0, 1, 0}},
        {"\"subset\", \"-a\"", {0, 0, 1}},       {"\"subset\", \"a,-b\"", {1, 0, 0}}, {"\"subset\", \"-b\"", {1, 0, 0}},
        {"\"excludesubset\", \"a\"", {0, 0, 1}}, {"\"subset\", \"x b\"", {0, 1, 0}},  {"\"subset\", \"x\"", {0, 0, 0}}};
    int n = 0;
    for (const auto& [pairs, want] : cases) {
        const std::string name = "subset" + std::to_string(n++), asked = pairs;
        expectColor(shows(name, "Ci = trace(P, up, " + asked + ");", kThree), want, asked);
        // Shadow rays: what is left after the panes of the set, which are opaque.
        const bool any = maxComponent(want) > 0;
        expectColor(shows(name + "t", "Ci = transmission(P, far, " + asked + ");", kThree), Color(any ? 0.f : 1.f),
                    "transmission " + asked);
    }
    // A name that is known only when the shader runs, and the attribute that holds where none is given.
    expectColor(shows("subsetrun",
                      "string g = \"a\"; if (xcomp(transform(\"world\", P)) < 50) g = \"b\"; Ci = trace(P, up, \"subset\", g);",
                      kThree),
                {0, 1, 0}, "computed");
    const std::string own = "Attribute \"grouping\" \"string tracesubset\" \"b\"";
    expectColor(shows("subsetown", "Ci = trace(P, up);", kThree, Hider::Raytrace, own), {0, 1, 0}, "tracesubset");
    expectColor(shows("subsetown2", "Ci = trace(P, up, \"subset\", \"-a\");", kThree, Hider::Raytrace, own), {0, 0, 1},
                "tracesubset and subset");
    // BMRT's rays and those of maps take the same words.
    expectColor(shows("subsetenv", "Ci = environment(\"raytrace\", up, \"subset\", \"b\");", kThree), {0, 1, 0}, "environment");
    expectColor(shows("subsetvis", "Ci = visibility(P, far, \"subset\", \"x\");", kThree), Color(1), "visibility");
    expectColor(shows("subsethit", "point h = P; vector n = 0; Ci = rayhittest(P, up, h, n, \"subset\", \"b\");", kThree),
                Color(2), "rayhittest");
    expectColor(shows("subsetfull",
                      "point h = P, m = P; vector n = 0, r = 0; float d = 0; color c = 0; float f = fulltrace(P, up, c, d, h, n, "
                      "m, r, \"subset\", \"-a\"); Ci = c * d;",
                      kThree),
                {0, 0, 3}, "fulltrace", 1e-4f);
}

TEST(RaySets, SidesOfOneSidedSurfaces) {
    // Two panes whose normals look opposite ways: from below one shows its front, the other its back.
    const std::string two =
        pane(1, "Sides 1 Color 1 0 0") + pane(2, "Sides 1 Color 0 1 0", true) + pane(3, "Sides 2 Color 0 0 1");
    const Color plain = shows("sides0", "Ci = trace(P, up);", two);
    const bool first = plain.x > .5f; // which of them looks down
    const Color front = first ? Color(1, 0, 0) : Color(0, 1, 0), back = first ? Color(0, 1, 0) : Color(1, 0, 0);
    expectColor(plain, front, "not given");
    expectColor(shows("sides1", "Ci = trace(P, up, \"hitsides\", \"front\");", two), front, "front");
    expectColor(shows("sides2", "Ci = trace(P, up, \"hitsides\", \"back\");", two), back, "back");
    expectColor(shows("sides3", "Ci = trace(P, up, \"hitsides\", \"reversed\");", two), back, "reversed");
    expectColor(shows("sides4", "Ci = trace(P, up, \"hitsides\", \"both\");", two), {1, 0, 0}, "both");
    // Two-sided surfaces are met whatever is asked; shadow rays, too, meet fronts unless they say otherwise.
    const std::string blue = pane(3, "Sides 2 Color 0 0 1"), one = pane(1, "Sides 1 Opacity .5 .5 .5");
    expectColor(shows("sides5", "Ci = trace(P, up, \"hitsides\", \"back\");", blue), {0, 0, 1}, "two sides");
    Color sum(0);
    for (const char* side : {"front", "back"}) {
        const Color t =
            shows(std::string("sidest") + side, std::string("Ci = transmission(P, far, \"hitsides\", \"") + side + "\");", one);
        EXPECT_TRUE(t.x == 1 || t.x == .5f) << t.x;
        sum += t;
    }
    expectColor(sum, Color(1.5f), "one of both sides");
    expectColor(shows("sidesb", "Ci = transmission(P, far, \"hitsides\", \"both\");", one), Color(.5f), "transmission");
    expectColor(shows("sidesn", "Ci = transmission(P, far) - transmission(P, far, \"hitsides\", \"front\");", one), Color(0),
                "none");
}

TEST(RaySets, HitModes) {
    writeShader("redwall", "surface redwall() { Oi = 1; Ci = color(1, 0, 0); }\n");
    const std::string shape = " Surface \"redwall\" Color 0 1 0 Opacity .5 .5 .5 ";
    const Color shaded(1, 0, 0), plain(0, .5f, 0);
    const auto of = [&](const char* name, const std::string& what, const std::string& attributes = "") {
        return shows(name, "Ci = " + what + ";", pane(1, attributes + shape));
    };
    const char* const shade = "Attribute \"shade\" \"string specularhitmode\" \"primitive\" ";
    expectColor(of("mode0", "trace(P, up)"), shaded, "default");
    expectColor(of("mode1", "trace(P, up, \"hitmode\", \"primitive\")"), plain, "primitive");
    expectColor(of("mode2", "trace(P, up, \"hitmode\", \"shader\")", shade), shaded, "shader");
    expectColor(of("mode3", "trace(P, up)", shade), plain, "attribute");
    expectColor(of("mode4", "trace(P, up, \"type\", \"diffuse\")", shade), shaded, "attribute of other rays");
    expectColor(of("mode5", "transmission(P, far)"), Color(0), "transmission");
    expectColor(of("mode6", "transmission(P, far, \"hitmode\", \"primitive\")"), Color(.5f), "transmission, primitive");
    const char* const opaque = "Attribute \"shade\" \"string transmissionhitmode\" \"primitive\" ";
    expectColor(of("mode7", "transmission(P, far)", opaque), Color(.5f), "transmission, attribute");
    expectColor(of("mode8", "transmission(P, far, \"hitmode\", \"shader\")", opaque), Color(0), "transmission, shader");
    // A primitive variable Os belongs to the primitive.
    const std::string varying = "AttributeBegin Surface \"redwall\" Polygon \"P\" [-9 1 -9  -9 1 9  9 1 9  9 1 -9] \"Os\" [.25 "
                                ".25 .25  .25 .25 .25  .25 .25 .25  .25 .25 .25] AttributeEnd\n";
    expectColor(shows("mode9", "Ci = transmission(P, far, \"hitmode\", \"primitive\");", varying), Color(.75f), "Os");
    EXPECT_NEAR(shows("mode10", "Ci = environment(\"raytrace\", up, \"hitmode\", \"primitive\");", pane(1, shape)).y, .5, 1e-5);
}

// "this environment() also accepts the same optional parameters as trace": outputs and arrays, too.
TEST(RaySets, EnvironmentTakesAllThatTraceTakes) {
    const std::string map = writeMap("rayssky.exr", 8, 4, Color(.25f, .5f, .75f)).substr(1), sky = map.substr(0, map.size() - 1);
    const std::string thin = pane(1, "Color 1 0 0 Opacity .75 .5 .25"),
                      asked = ", \"environmentmap\", \"" + sky + "\", \"environmenttint\", color(2, 1, 1)";
    for (Hider h : {Hider::Hidden, Hider::Raytrace, Hider::Path}) {
        expectColor(shows("envall0", "Ci = environment(\"raytrace\", up" + asked + ");", thin, h), {.875f, .25f, .5625f},
                    "map and tint");
        expectColor(
            shows("envall1", "color c = 0; Ci = 0 * environment(\"raytrace\", up, \"transmission\", c); Ci += c;", thin, h),
            {.25f, .5f, .75f}, "transmission");
        expectColor(
            shows("envall2",
                  "color c = 0; Ci = 0 * environment(\"raytrace\", up" + asked + ", \"environmentcontribution\", c); Ci += c;",
                  thin, h),
            {.125f, .25f, .5625f}, "contribution");
        expectColor(
            shows("envall3",
                  "color c = 0; Ci = 0 * environment(\"raytrace\", up" + asked + ", \"unshadowedenvironment\", c); Ci += c;",
                  thin, h),
            {.5f, .5f, .75f}, "unshadowed");
        // Refraction alone: what stands below the floor, but for the .04 that glass reflects. (A path follows one of the rays.)
        if (h != Hider::Path)
            expectColor(shows("envall4",
                              "Ci = environment(\"raytrace\", up, \"samples\", 4096, \"distribution\", \"glass-ggx\", "
                              "\"roughness\", .01, \"wo\", up, \"lobeparameters\", {0, 1});",
                              thin + pane(-1, "Color 0 0 1"), h),
                        {0, 0, .96f}, "arrays", .02f);
        // Glass of the index of what is about it does nothing.
        if (h != Hider::Path)
            expectColor(shows("envall6",
                              "Ci = environment(\"raytrace\", up, \"samples\", 4096, \"distribution\", \"glass-ggx\", "
                              "\"roughness\", .2, \"eta\", 1, \"wo\", up);",
                              thin + pane(-1, "Color 0 0 1"), h),
                        {0, 0, 1}, "index 1", .02f);
        // A file has no rays: what is theirs alone stays as it is.
        expectColor(shows("envall5",
                          "color c = color(0, 1, 0); color e = environment(\"" + sky +
                              "\", up, \"transmission\", c, \"environmenttint\", color(9)); Ci = e + c;",
                          thin, h),
                    {.25f, 1.5f, .75f}, "a file", 1e-3f);
    }
}

TEST(RaySets, EnvironmentWithEveryParameter) {
    writeShader("envevery",
                R"(surface envevery() { color a = 0, b = 0, c = 0, d = 0, e = 0; vector n = 0, up = vector "world" (0, 1, 0);
        Ci = environment("raytrace", up, "type", "specular", "weight", color(.5), "samplebase", .5, "raytype", "specular",
                         "raylabel", "l", "maxhitdist", 9, "distribution", "ward", "wo", up, "horizon", up, "roughness", .2,
                         "roughnessv", .3, "udir", vector(1, 0, 0), "eta", color(0), "absorption", color(.1),
                         "lobeparameters", {1, 1}, "environmentmap", "", "environmentspace", "world", "environmenttint", color(2),
                         "exponent", 20, "samplearealights", 1, "transmission", a, "hitnormal", n, "environmentcontribution", b,
                         "unshadowedenvironment", c, "arealightcontribution", d, "unshadowedarealight", e, "samples", 4)
            + environment("raytrace", up, "bsdf", "cosine", "samplecone", .2, "samplelights", 1);
        Ci += 0 * (a + b + c + d + e + color(n)); Oi = 1; })");
    for (const Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s(inWorld("Surface \"envevery\" " + std::string(kFloor) + pane(1, "Color .25 .5 .75")), withShaders(h));
        const Color c = s.one(kLow);
        EXPECT_TRUE(std::isfinite(c.x) && c.y > 0) << c.x;
        EXPECT_EQ(s.messages().find("has no parameter"), std::string::npos) << s.messages();
    }
}

TEST(RaySets, DistancesTypesAndLabels) {
    expectColor(shows("bias0", "Ci = trace(P, up, \"bias\", 1.5);", kThree), {0, 1, 0}, "bias");
    expectColor(shows("bias1", "Ci = transmission(P, far, \"bias\", 4);", kThree), Color(1), "bias of transmission");
    expectColor(shows("bias2", "Ci = trace(P, up);", kThree, Hider::Raytrace, "Attribute \"trace\" \"float bias\" 2.5"),
                {0, 0, 1}, "trace:bias");
    expectColor(
        shows("bias3", "Ci = trace(P, up, \"bias\", 1.5);", kThree, Hider::Raytrace, "Attribute \"trace\" \"float bias\" 2.5"),
        {0, 1, 0}, "bias and trace:bias");
    expectColor(shows("dist0", "Ci = trace(P, up, \"maxdist\", .5);", kThree), Color(0), "maxdist");
    expectColor(shows("dist1", "Ci = transmission(P, far, \"maxdist\", .5);", kThree), Color(1), "maxdist of transmission");
    expectColor(shows("dist2", "Ci = environment(\"raytrace\", up, \"maxdist\", .5);", kThree), Color(0),
                "maxdist of environment");
    // The form that gives a distance sees what shadow rays see.
    const std::string seen =
        pane(1, "Attribute \"visibility\" \"int transmission\" 0 \"int specular\" 1 \"int diffuse\" 1") +
        pane(2, "Attribute \"visibility\" \"int transmission\" 1 \"int specular\" 0 \"int diffuse\" 0 Color 0 1 0");
    expectColor(shows("far0", "float d = trace(P, up); Ci = d;", seen), Color(2), "distance", 1e-4f);
    expectColor(shows("far1", "Ci = trace(P, up, \"type\", \"transmission\");", seen), {0, 1, 0}, "type");
    expectColor(shows("far2", "Ci = transmission(P, far, \"type\", \"specular\", \"maxdist\", 1.5);", seen), Color(0),
                "type of transmission");
    writeShader("labelled", "surface labelled() { string l = \"\"; rayinfo(\"label\", l); Oi = (l == \"thin\") ? .25 : 1; Ci = "
                            "(l == \"red\") ? color(1, 0, 0) : color(0, 0, 1); }\n");
    const std::string labelled = pane(1, "Surface \"labelled\"");
    expectColor(shows("label0", "Ci = trace(P, up, \"label\", \"red\");", labelled), {1, 0, 0}, "label");
    expectColor(shows("label1", "Ci = environment(\"raytrace\", up, \"label\", \"red\");", labelled), {1, 0, 0},
                "label of environment");
    expectColor(shows("label2", "Ci = transmission(P, far, \"label\", \"thin\");", labelled), Color(.75f),
                "label of transmission");
    expectColor(shows("label3", "string w = (xcomp(P) < 50) ? \"red\" : \"x\"; Ci = trace(P, up, \"label\", w);", labelled),
                {1, 0, 0}, "computed label");
}

TEST(RaySets, ConesOfRays) {
    // A pane over half of the world: half of a cone about the upright meets it. One over all of it, far out: a cone of a
    // hemisphere.
    const std::string half =
        "AttributeBegin Surface \"constant\" Polygon \"P\" [0 1 -900  0 1 900  900 1 900  900 1 -900] AttributeEnd\n";
    const std::string whole = "AttributeBegin Surface \"constant\" Sphere 900 -900 900 360 AttributeEnd\n";
    const auto mean = [&](const char* name, const std::string& ci, const std::string& what) {
        writeShader(name,
                    std::string("surface ") + name + "() { vector up = vector \"world\" (0, 1, 0); Oi = 1; Ci = " + ci + "; }\n");
        Scene s(inWorld(std::string("AttributeBegin Surface \"") + name + "\" " + kFloor + "AttributeEnd\n" + what),
                withShaders(Hider::Raytrace));
        return s.estimate(kLow, samples(2000));
    };
    expectMean(mean("cone0", "transmission(P, P + 5 * up, \"samplecone\", .3, \"samples\", 4)", half), .5, .05, "transmission");
    expectMean(mean("cone1", "environment(\"raytrace\", up, \"samplecone\", .3, \"samples\", 4)", half), .5, .05, "environment");
    expectMean(mean("cone2", "environment(\"raytrace\", up, \"blur\", .1)", half), .5, .05, "blur");
    expectMean(mean("cone3", "environment(\"raytrace\", up, \"blur\", .5)", whole), 1, .01, "a hemisphere");
    expectMean(mean("cone4",
                    "environment(\"raytrace\", up + vector \"world\" (.1, 0, .1), up + vector \"world\" (-.1, 0, .1), up + "
                    "vector \"world\" (.1, 0, -.1), up + vector \"world\" (-.1, 0, -.1))",
                    half),
               .5, .05, "four corners");
}

TEST(RaySets, MapsThatAreRays) {
    const std::string wall = pane(1, "Color .25 .5 .75");
    expectColor(shows("env0", "Ci = environment(\"raytrace\", up);", wall), {.25f, .5f, .75f}, "color");
    expectColor(shows("env1", "Ci = float environment(\"raytrace\"[1], up);", wall), Color(.5f), "channel");
    expectColor(shows("env2", "Ci = environment(\"raytrace\", up, \"width\", 2, \"filter\", \"box\");", wall), {.25f, .5f, .75f},
                "filters of maps");
    expectColor(shows("env4", "Ci = environment(\"raytrace\", -up);", wall), Color(0), "nothing there");
    writeShader("mirrors", "surface mirrors(string map = \"\") { Oi = 1; Ci = environment(map, vector \"world\" (0, 1, 0)); }\n");
    Scene s(inWorld(std::string("AttributeBegin Surface \"mirrors\" \"string map\" \"raytrace\" ") + kFloor + "AttributeEnd\n" +
                    wall),
            withShaders(Hider::Raytrace));
    expectColor(s.one(kLow), {.25f, .5f, .75f}, "parameter");
    EXPECT_EQ(s.messages(), "");
}

TEST(RaySets, ShadowsThatAreRays) {
    // A lamp at height 2 with Cl = 4 / d^2 gives the floor 1, the sun gives it 1; a pane of opacity 1/4 leaves 3/4 of both.
    const std::string at = "illuminate(point \"world\" (0, 2, 0)) { Cl = 4 / (L . L); ",
                      down = "solar(vector \"world\" (0, -1, 0), 0) { Cl = 1; ";
    int n = 0;
    for (const std::string& begin : {at, down})
        for (const char* take : {"Cl *= 1 - shadow(map, Ps);", "Cl *= 1 - color shadow(map, Ps, \"samples\", 4, \"bias\", 0.01);",
                                 "Cl *= 1 - shadow(map, Ps, Ps, Ps, Ps);", "float s = shadow(map, Ps); if (s > .1) Cl *= .75;"}) {
            const std::string name = "shadowed" + std::to_string(n++);
            writeShader(name, "light " + name + "(string map = \"\") { " + begin + take + " } }\n");
            const auto of = [&](const std::string& over) {
                return Scene(inWorld("LightSource \"" + name +
                                     "\" 1 \"string map\" \"raytrace\" AttributeBegin Surface \"matte\" \"Ka\" 0 \"Kd\" 1 " +
                                     kFloor + "AttributeEnd\n" + over),
                             withShaders(Hider::Hidden))
                    .one(kLow)
                    .x;
            };
            EXPECT_NEAR(of(""), 1, 1e-5) << begin << take;
            EXPECT_NEAR(of(pane(1, "Opacity .25 .25 .25")), .75, 1e-5) << begin << take;
        }
    // In an illuminance loop: as far as the light of this turn.
    writeShader("lamp", "light lamp() { illuminate(point \"world\" (0, 2, 0)) Cl = 1; }\n");
    const std::string lamp = "LightSource \"lamp\" 1\n";
    writeShader("looped",
                "surface looped() { Oi = 1; Ci = 0; illuminance(P, N, PI) Ci += Cl * (1 - shadow(\"raytrace\", P)); }\n");
    const auto of = [&](const std::string& over) {
        return Scene(inWorld(lamp + "AttributeBegin Surface \"looped\" " + kFloor + "AttributeEnd\n" + over),
                     withShaders(Hider::Hidden))
            .one(kLow)
            .x;
    };
    EXPECT_NEAR(of(pane(1, "Opacity .25 .25 .25")), .75, 1e-5);
    EXPECT_NEAR(of(pane(3, "Opacity .25 .25 .25")), 1, 1e-5);
}

TEST(RaySets, LightsThatTrace) {
    // A light that takes its colour from what is straight above the lit point, and one that asks how far that is.
    const std::string wall = pane(2, "Color .25 .5 .75");
    const auto of = [&](const std::string& name, const std::string& body) {
        writeShader(name, "light " + name +
                              "() { vector up = vector \"world\" (0, 1, 0); illuminate(point \"world\" (0, 1, 0)) { " + body +
                              " } }\n");
        return Scene(inWorld("LightSource \"" + name + "\" 1 AttributeBegin Surface \"matte\" \"Ka\" 0 \"Kd\" 1 " + kFloor +
                             "AttributeEnd\n" + wall),
                     withShaders(Hider::Hidden))
            .one(kLow);
    };
    expectColor(of("above0", "Cl = trace(Ps, up);"), {.25f, .5f, .75f}, "colour");
    expectColor(of("above1", "float d = 0; color c = trace(Ps, up, d); Cl = d * .25;"), Color(.5f), "distance");
    expectColor(of("above2", "float d = trace(Ps, up); Cl = (d > 1.5) ? 1 : 0;"), Color(1), "the form that gives a distance");
    expectColor(of("above3", "Cl = environment(\"raytrace\", up);"), {.25f, .5f, .75f}, "environment");
    expectColor(of("above4", "color t = 0; color c = trace(Ps, up, \"transmission\", t, \"maxdist\", 1); Cl = t;"), Color(1),
                "transmission");
    // Lights that trace are seen by rays that lights send: the wall is matte and lit by the same lamp, one bounce deeper.
    writeShader("above5", "light above5() { illuminate(point \"world\" (0, 1, 0)) Cl = .5 + trace(Ps, vector \"world\" (0, 1, "
                          "0), \"maxdist\", 3); }\n");
    Scene deep(inWorld(std::string("LightSource \"above5\" 1 Surface \"matte\" \"Ka\" 0 \"Kd\" 1 ") + kFloor +
                       "Polygon \"P\" [-9 2 -9  -9 2 9  9 2 9  9 2 -9]\n"),
               withShaders(Hider::Hidden));
    expectColor(deep.one(kLow), Color(1), "two bounces: .5 of the lamp, and .5 that it gives to the wall");
}

} // namespace

} // namespace raysets_test

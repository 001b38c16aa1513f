// Co-shaders that call each other through arrays of handles; the handles light, surface and caller; what asks about a light, a
// map, a primitive or a space by a name. Closed forms.
#include "display/imageio.h"
#include "integrator/harness.h"

namespace handles_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"st\" [0 0 1 0 1 1 0 1]\n";

struct Seen {
    Color color;
    std::string said;
};
Seen seen(const std::string& world, const std::string& shape = kSquare, Vec3 at = {.2f, .3f, 2}) {
    Scene s("WorldBegin\n" + world + shape + "WorldEnd\n");
    Seen r{s.one(rayTo({0, 0, 0}, at)), ""};
    r.said = s.messages();
    return r;
}
void expectColor(const Color& c, const Color& want, float within = 1e-5f) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], want[k], within) << k;
}

void writeLight() {
    writeShader(
        "handlelight",
        "light handlelight(string __group = \"key\"; float power = 4;) { solar(vector \"world\" (0, 0, 1), 0) Cl = power; }\n");
}

void writeLayers() {
    writeShader(
        "handlelayer",
        "class handlelayer(color tint = 1; shader below[] = {};) {\n    public color get() {\n        color c = tint * .25;\n"
        "        if (arraylength(below) > 0) c += below[0]->get();\n        return c;\n    }\n}\n");
    writeShader("handleloop",
                "class handleloop(color tint = 1; shader below[] = {};) {\n    public color get() {\n        color c = tint * "
                ".25;\n        float i;\n"
                "        for (i = 0; i < arraylength(below); i += 1) c += below[i]->get();\n        return c;\n    }\n}\n");
    writeShader("handletop", "class handletop(shader layers[] = {};) {\n    public void surface(output color Ci, Oi) { Oi = 1; "
                             "Ci = layers[0]->get(); }\n}\n");
}

TEST(Handles, LayersCallThoseBelowThem) {
    writeLayers();
    for (const std::string layer : {"handlelayer", "handleloop"}) {
        const Seen two = seen("Shader \"" + layer + "\" \"B\" \"color tint\" [0 1 0]\nShader \"" + layer +
                              "\" \"A\" \"color tint\" [1 0 0] \"string[1] below\" [\"B\"]\n"
                              "Surface \"handletop\" \"string[1] layers\" [\"A\"]\n");
        expectColor(two.color, {.25f, .25f, 0});
        EXPECT_EQ(two.said, "");
        const Seen three = seen(
            "Shader \"" + layer + "\" \"C\" \"color tint\" [0 0 2]\nShader \"" + layer +
            "\" \"B\" \"color tint\" [0 1 0] \"string[1] below\" [\"C\"]\nShader \"" + layer +
            "\" \"A\" \"color tint\" [1 0 0] \"string[1] below\" [\"B\"]\nSurface \"handletop\" \"string[1] layers\" [\"A\"]\n");
        expectColor(three.color, {.25f, .25f, .5f});
        EXPECT_EQ(three.said, "");
    }
    const Seen many =
        seen("Shader \"handleloop\" \"C\" \"color tint\" [0 0 2]\nShader \"handleloop\" \"B\" \"color tint\" [0 1 0]\n"
             "Shader \"handleloop\" \"A\" \"color tint\" [1 0 0] \"string[3] below\" [\"B\" \"C\" \"B\"]\nSurface \"handletop\" "
             "\"string[1] layers\" [\"A\"]\n");
    expectColor(many.color, {.25f, .5f, .5f});
    EXPECT_EQ(many.said, "");
}

TEST(Handles, ACircleOfLayersEnds) {
    writeLayers();
    Scene s(std::string("WorldBegin\nShader \"handleloop\" \"B\" \"color tint\" [0 1 0] \"string[1] below\" [\"A\"]\n"
                        "Shader \"handleloop\" \"A\" \"color tint\" [1 0 0] \"string[1] below\" [\"B\"]\nSurface \"handletop\" "
                        "\"string[1] layers\" [\"A\"]\n") +
            kSquare + "WorldEnd\n");
    expectColor(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})), {.25f, .25f, 0});
    EXPECT_NE(s.messages().find("calls itself"), std::string::npos) << s.messages();
}

TEST(Handles, ThatLackAMethodAreNotMeant) {
    writeShader("handlehas", "class handlehas(float k = 1;) { public float twice(float x) { return 2 * x * k; } }\n");
    writeShader("handlehasnot", "class handlehasnot(float k = 7;) { public float thrice(float x) { return 3 * x; } }\n");
    writeShader(
        "handleasks",
        "class handleasks(float which = 0;) { public void surface(output color Ci, Oi) { shader all[] = getshaders(); Oi = 1;\n"
        "    string name = (which + u * 0 > 0) ? \"b\" : \"a\"; shader h = getshader(name); Ci = h->twice(5); } }\n");
    const Seen r = seen("Shader \"handlehas\" \"a\" \"float k\" [3]\nShader \"handlehasnot\" \"b\"\nSurface \"handleasks\"\n");
    expectColor(r.color, {30, 30, 30});
    EXPECT_EQ(r.said, "");
}

TEST(Handles, LightSurfaceAndCaller) {
    writeLight();
    writeShader(
        "handlesees",
        "surface handlesees(string name = \"power\";) { Ci = 0; Oi = 1;\n    illuminance(P) { string g = \"none\"; float p = 0;\n"
        "        if (getvar(light, \"__group\", g) == 1 && g == \"key\") { getvar(light, name, p); Ci += color(1, p, "
        "light->power); } } }\n");
    const Seen lit = seen("LightSource \"handlelight\" 1\nSurface \"handlesees\"\n");
    expectColor(lit.color, {1, 4, 4});
    EXPECT_EQ(lit.said, "");

    writeShader("handlecalled", "class handlecalled() { public color ask() { float f = 0, g = 0; getvar(caller, \"gain\", f); "
                                "getvar(surface, \"gain\", g); return color(f, g, caller == surface ? 1 : 0); } }\n");
    writeShader(
        "handlebetween",
        "class handlebetween(float gain = 9;) { public color pass() { shader h = getshader(\"a\"); return h->ask(); } }\n");
    writeShader("handlecalls", "class handlecalls(float gain = 5; float between = 0;) { public void surface(output color Ci, Oi) "
                               "{ Oi = 1; shader h = getshader(\"a\"), g = getshader(\"b\");\n"
                               "    if (between > 0) Ci = g->pass(); else Ci = h->ask(); } }\n");
    const std::string both = "Shader \"handlecalled\" \"a\"\nShader \"handlebetween\" \"b\"\nSurface \"handlecalls\" ";
    expectColor(seen(both + "\n").color, {5, 5, 1});
    expectColor(seen(both + "\"float between\" [1]\n").color, {9, 5, 0});

    writeShader("handlelightasks", "light handlelightasks() { float k = 0; getvar(surface, \"gain\", k); solar(vector \"world\" "
                                   "(0, 0, 1), 0) Cl = color(k, surface->gain, 0); }\n");
    writeShader("handlesum", "surface handlesum(float gain = 3;) { Ci = 0; Oi = 1; illuminance(P) Ci += Cl; }\n");
    expectColor(seen("LightSource \"handlelightasks\" 1\nSurface \"handlesum\" \"float gain\" [6]\n").color, {6, 6, 0});
}

TEST(Handles, NamesThatAreMadeWhenTheShaderRuns) {
    writeShader("handlenamed",
                "class handlenamed(float k = 1, j = 2; string __category = \"\"; color c = 1;) { public float member = 4; }\n");
    writeShader("handlenames", "class handlenames(string n = \"j\", cat = \"wet\";) { public void surface(output color Ci, Oi) { "
                               "Oi = 1; float f = 0, found = 0; shader h = getshader(\"a\");\n"
                               "    string name = n; if (u > 2) name = \"k\"; found = getvar(h, name, f); string category = cat; "
                               "if (u > 2) category = \"dry\";\n"
                               "    shader all[] = getshaders(\"category\", category); float i, sum = 0; for (i = 0; i < "
                               "arraylength(all); i += 1) sum = sum * 10 + all[i]->k;\n"
                               "    Ci = color(f, found, sum); } }\n");
    const std::string bound =
        "Shader \"handlenamed\" \"a\" \"float k\" [5] \"string __category\" [\"wet\"]\nShader \"handlenamed\" \"b\" \"float k\" "
        "[6] \"string __category\" [\"dry\"]\n"
        "Shader \"handlenamed\" \"c\" \"float k\" [7] \"string __category\" [\"wet\"]\nSurface \"handlenames\" ";
    expectColor(seen(bound + "\n").color, {2, 1, 57});
    expectColor(seen(bound + "\"string n\" [\"member\"] \"string cat\" [\"dry\"]\n").color, {4, 1, 6});
    expectColor(seen(bound + "\"string n\" [\"c\"] \"string cat\" [\"none\"]\n").color, {0, 0, 0}); // a colour does not fit
}

TEST(Handles, WhatAsksAboutTheLightOutsideOfLoopsHasNoAnswer) {
    writeShader("handlegone", "surface handlegone() { Ci = 0; Oi = 1; float inside = 0, after = 7, group = 7;\n    "
                              "illuminance(P) { float p = 0; inside += lightsource(\"power\", p) * p; }\n"
                              "    float found = lightsource(\"power\", after) + attribute(\"light:user:group\", group) + "
                              "islightcategory(\"\");\n    Ci = color(inside, found, after + group); }\n");
    writeLight();
    const Seen r = seen("Attribute \"user\" \"float group\" [3]\nLightSource \"handlelight\" 1\nSurface \"handlegone\"\n");
    expectColor(r.color, {4, 0, 14});
    EXPECT_NE(r.said.find("lightsource() asks about the light of an illuminance loop; there is none here"), std::string::npos)
        << r.said;
}

TEST(Handles, MapsThatAreNotThereAreNoFaultOfWhoAsks) {
    writeShader("handlemap", "surface handlemap(string map = \"notthere.tif\", field = \"exists\";) { float e = 5, c = 6; Oi = "
                             "1; string f = field; if (u > 2) f = \"type\";\n"
                             "    float one = textureinfo(map, \"exists\", e), two = textureinfo(map, f, c); Ci = color(e + one "
                             "* 0, c, two * 0); }\n");
    const Seen r = seen("Surface \"handlemap\"\n");
    EXPECT_EQ(r.said, "");
    EXPECT_FLOAT_EQ(r.color.y, 6);
}

// A filter that is made when the shader runs reads as the one that is written down.
TEST(Handles, FiltersOfMapsMayBeMadeWhenTheShaderRuns) {
    display::Image m = display::makeImage(64, 64, display::defaultChannels(3));
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c) m.pixel(x, y)[c] = x < 32 ? 0.f : 1.f;
    Diagnostics d;
    display::WriteOptions o;
    o.format = display::Format::Exr;
    o.sample = display::Sample::Float;
    o.policy = {shaderFolder(), false, -1};
    ASSERT_TRUE(display::writeImage("handlestep.exr", m, o, d));
    writeShader(
        "handlefilter",
        "surface handlefilter(string map = \"" + shaderFolder() +
            "/handlestep.exr\";) { Oi = 1; string f = (u < 2) ? \"box\" : \"gaussian\", g = (u < 2) ? \"gaussian\" : \"box\";\n"
            "    float b = texture(map, .4, .5, \"blur\", .5, \"filter\", \"box\"), w = texture(map, .4, .5, \"blur\", .5, "
            "\"filter\", \"gaussian\");\n"
            "    float fb = texture(map, .4, .5, \"blur\", .5, \"filter\", f), fw = texture(map, .4, .5, \"blur\", .5, "
            "\"filter\", g);\n"
            "    Ci = color(abs(fb - b), abs(fw - w), abs(b - w) > .001 ? 1 : 0); }\n");
    expectColor(seen("Surface \"handlefilter\"\n").color, {0, 0, 1});
}

TEST(PrimitiveText, CountsMoreThanTheParameterOfItsName) {
    writeShader("textvar", "surface textvar(string name = \"none\"; string other = \"own\";) { Oi = 1; Ci = color(name == "
                           "\"prim\" ? 1 : name == \"second\" ? 2 : 0, other == \"own\" ? 1 : 0, 0); }\n");
    expectColor(seen("Surface \"textvar\" \"string name\" [\"given\"]\n",
                     "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"constant string name\" [\"prim\"]\n")
                    .color,
                {1, 1, 0});
    expectColor(seen("Surface \"textvar\"\n", kSquare).color, {0, 1, 0});
    const std::string two = "PointsPolygons [4 4] [0 1 2 3 1 4 5 2] \"P\" [-1 -1 2  0 -1 2  0 1 2  -1 1 2  1 -1 2  1 1 2] "
                            "\"uniform string name\" [\"prim\" \"second\"]\n";
    expectColor(seen("Surface \"textvar\"\n", two, {-.5f, .3f, 2}).color, {1, 1, 0});
    expectColor(seen("Surface \"textvar\"\n", two, {.5f, .3f, 2}).color, {2, 1, 0});
}

// "object" is the space of the primitive, "shader" that of the shader call.
TEST(DefaultSpaces, AreThoseTheyName) {
    writeShader("spacedefault",
                "surface spacedefault(point o = point \"object\" (0, 0, 0); point h = point \"shader\" (0, 0, 0); vector w = "
                "vector \"wide\" (1, 0, 0); point p = transform(\"object\", \"current\", point(1, 0, 0));)\n"
                "{ Oi = 1; Ci = color(xcomp(o), xcomp(h), xcomp(w)) + color(0, 0, 100 * xcomp(p)); }\n");
    const std::string scene =
        "Translate 2 0 0\nScale 3 1 1\nCoordinateSystem \"wide\"\nScale .33333333 1 1\nSurface \"spacedefault\"\n";
    Scene s("WorldBegin\n" + scene + "TransformBegin\nTranslate -2 0 0\n" + std::string(kSquare) +
            "TransformEnd\nTranslate -2 4 0\nTranslate .25 0 0\n" + kSquare + "WorldEnd\n");
    expectColor(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})), {0, 2, 103}, 1e-3f);
    expectColor(s.one(rayTo({0, 0, 0}, {.2f, 4.3f, 2})), {.25f, 2, 3 + 125}, 1e-3f);
    EXPECT_EQ(s.messages(), "");
}

TEST(DefaultSpaces, AreThoseThatAnEarlierParameterNames) {
    writeShader("spaceby", "surface spaceby(string in = \"object\"; point o = point in (0, 0, 0);) { Oi = 1; Ci = color(o); }\n");
    Scene s("WorldBegin\nSurface \"spaceby\"\nTransformBegin\nTranslate .5 0 0\n" + std::string(kSquare) +
            "TransformEnd\nTranslate .25 4 0\n" + kSquare + "WorldEnd\n");
    expectColor(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})), {.5f, 0, 0});
    expectColor(s.one(rayTo({0, 0, 0}, {.2f, 4.3f, 2})), {.25f, 4, 0});
    EXPECT_EQ(s.messages(), "");
}

TEST(DefaultSpaces, UnknownOnesAreSaidWhereTheyStand) {
    writeShader("spacewrong", "surface spacewrong(\n    point o = point \"nowhere\" (3, 0, 0);)\n{ Oi = 1; point q = "
                              "transform(\"elsewhere\", P);\n  Ci = color(xcomp(o), xcomp(q), 0); }\n");
    const Seen r = seen("Surface \"spacewrong\"\n");
    expectColor(r.color, {3, .2f, 0});
    EXPECT_NE(r.said.find("spacewrong.sl:2:21"), std::string::npos) << r.said;
    EXPECT_NE(r.said.find("unknown coordinate system \"nowhere\""), std::string::npos) << r.said;
    EXPECT_NE(r.said.find("spacewrong.sl:3:31"), std::string::npos) << r.said;
    EXPECT_NE(r.said.find("unknown coordinate system \"elsewhere\""), std::string::npos) << r.said;
}

TEST(DefaultSpaces, UnknownOnesAreSaidAtTheParameterThatNamesThem) {
    writeShader("spaceempty", "surface spaceempty(string map = \"\";\n    string in = \"\";)\n{ Oi = 1; if (map == \"\") Ci = "
                              "color(xcomp(transform(in, P)), 0, 0); }\n");
    const Seen r = seen("Surface \"spaceempty\"\n");
    EXPECT_NE(r.said.find("spaceempty.sl:2:17"), std::string::npos) << r.said;
    EXPECT_NE(r.said.find("unknown coordinate system \"\""), std::string::npos) << r.said;
}

TEST(OpenParameters, ReadBehindTheirDefaultWhereTheSceneGivesMore) {
    writeShader("openread", "surface openread(float a[] = {1}; color c[] = {};) { Oi = 1; float x = 0; if (arraylength(a) > 2) x "
                            "= a[2]; Ci = color(x, a[5], u * 0) + c[1]; }\n");
    expectColor(seen("Surface \"openread\" \"float[3] a\" [4 5 6]\n").color, {6, 0, 0});
    expectColor(seen("Surface \"openread\" \"color[2] c\" [1 1 1 2 3 4]\n").color, {2, 3, 4});
}

// 3Delight manual, 6.1.1.2: rays that only want to know what stops them run opacity() alone.
TEST(ShadowOpacity, IsWhatTheMethodOpacityGives) {
    writeShader("opacityfirst",
                "class opacityfirst(float by = 1;) { public void opacity(output color Oi) { Oi = color(.25, .5, .75) * by; }\n"
                "    public void surface(output color Ci, Oi) { Oi = 1; Ci = 0; } }\n");
    const std::string world = "Sides 2\nLightSource \"distantlight\" 1 \"point from\" [0 1 0] \"point to\" [0 0 "
                              "0]\nAttributeBegin\nSurface \"opacityfirst\"";
    const std::string rest = "\nPatch \"bilinear\" \"P\" [-1 1 -1  1 1 -1  -1 1 1  1 1 1]\nAttributeEnd\nSurface "
                             "\"matte\"\nPolygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60]\nWorldEnd\n";
    Settings set;
    set.hider = Hider::Path;
    for (const auto& [given, want] :
         {std::pair<std::string, Color>{"", {.75f, .5f, .25f}}, {" \"float by\" [.5]", {.875f, .75f, .625f}}}) {
        Scene s("WorldBegin\n" + world + given + rest, set);
        expectColor(s.one(rayTo({.3f, .5f, -.1f}, {.3f, 0, .2f})), want);
    }
}

} // namespace

} // namespace handles_test

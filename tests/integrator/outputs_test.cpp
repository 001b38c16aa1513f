// Outputs as displays ask for them, arrays of other shaders, and variables of the primitive: rendered scenes against closed
// forms.
#include "integrator/floorscene.h"

namespace outputs_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

std::vector<float> aovs(const std::string& rib, Hider h, const std::vector<std::string>& outputs,
                        const std::vector<int>& widths = {}) {
    Settings set = under(h);
    set.outputs = outputs;
    set.outputWidths = widths;
    Scene s(inWorld(rib + kFloor), set);
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    return s.trace(std::vector<CameraRay>{kView})[0].aovs;
}
using Floats = std::vector<float>;

// As many numbers as the shader has: a float one, an array all of its elements, an element one; what nobody gives, as the display
// says.
TEST(Outputs, AsManyNumbersAsTheShaderHas) {
    writeShader("gives",
                R"(surface gives(output varying float q = 0; output varying float list[3] = {0, 0, 0};
                         output varying color tones[2] = {0, 0};) {
    q = 7; list[0] = 1; list[1] = 2; list[2] = 3; tones[1] = color(4, 5, 6);
    float made[2] = {8, 9};
    outputchannel("made", made);
    string names[2] = {"byname", "nobody"};
    float i;
    for (i = 0; i < 2; i += 1) outputchannel(names[i], 11 + i);
    Oi = 1; Ci = 0;
}
)");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        EXPECT_EQ(aovs("Surface \"gives\"\n", h, {"q", "list", "z0"}, {0, 0, 1}), (Floats{7, 1, 2, 3, 0}));
        EXPECT_EQ(aovs("Surface \"gives\"\n", h, {"list[1]", "tones[1]", "made", "byname"}), (Floats{2, 4, 5, 6, 8, 9, 11}));
        EXPECT_EQ(aovs("Surface \"gives\"\n", h, {"tones", "made[1]"}), (Floats{0, 0, 0, 4, 5, 6, 9}));
        EXPECT_EQ(aovs("Surface \"constant\"\n", h, {"other"}), (Floats{0, 0, 0}));
    }
}

// An output that only the atmosphere has: what it gives, also by outputchannel(); that of the surface comes first.
TEST(Outputs, OfTheAtmosphere) {
    writeShader("mist", "volume mist(output varying float thick = 0;) { thick = length(I); outputchannel(\"mist\", color(1, 2, "
                        "3)); outputchannel(\"both\", 5.0); Ci = Ci; Oi = Oi; }\n");
    writeShader("below", "surface below(output varying float both = 0;) { both = 6; Oi = 1; Ci = 0; }\n");
    const float way = length(Vec3(.3f, .8f, -.4f));
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const Floats a = aovs("Atmosphere \"mist\"\nSurface \"below\"\n", h, {"thick", "mist", "both"});
        ASSERT_EQ(a.size(), 5u);
        EXPECT_NEAR(a[0], way, 1e-5);
        EXPECT_EQ(Floats(a.begin() + 1, a.end()), (Floats{1, 2, 3, 6}));
    }
}

// Outputs of lights: arrays, and names that are made when the shader runs.
TEST(Outputs, OfLights) {
    writeShader("tellsmore", R"(light tellsmore() {
    float list[2] = {3, 4};
    string n = "made";
    if (xcomp(Ps) > 1000) n = "other";
    illuminate(point "world" (0, 2, 0)) { Cl = 1; outputchannel("list", list); outputchannel(n, length(L)); }
}
)");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const Floats a = aovs("LightSource \"tellsmore\" 1\nSurface \"matte\"\n", h, {"made", "list"});
        ASSERT_EQ(a.size(), 3u);
        EXPECT_NEAR(a[0], 2, 1e-5);
        EXPECT_EQ(Floats(a.begin() + 1, a.end()), (Floats{3, 4}));
    }
}

// A surface that makes its names when it runs may give any: where it does not, what the atmosphere and the lights give is shown.
TEST(Outputs, NamesMadeByTheSurfaceHideNobody) {
    writeShader("mist", "volume mist(output varying float thick = 0;) { thick = length(I); outputchannel(\"mist\", color(1, 2, "
                        "3)); outputchannel(\"both\", 5.0); Ci = Ci; Oi = Oi; }\n");
    writeShader("names", "surface names(string mine = \"own\"; float way = 0;) { string n = (xcomp(P) > 1000) ? \"nobody\" : "
                         "mine; outputchannel(n, color(7, 8, 9)); Oi = 1; Ci = diffuse(faceforward(N, I)); }\n");
    writeShader("far", "light far() { illuminate(point \"world\" (0, 2, 0)) { Cl = 1; outputchannel(\"far\", length(L)); } }\n");
    const float way = length(Vec3(.3f, .8f, -.4f));
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        const std::string begin = "LightSource \"far\" 1\nAtmosphere \"mist\"\nSurface \"names\" \"mine\" ";
        const Floats a = aovs(begin + "\"own\"\n", h, {"own", "mist", "thick", "far"});
        ASSERT_EQ(a.size(), 8u); // as wide as those give them that give them for certain
        EXPECT_EQ(Floats(a.begin(), a.begin() + 6), (Floats{7, 8, 9, 1, 2, 3}));
        EXPECT_NEAR(a[6], way, 1e-5);
        EXPECT_NEAR(a[7], 2, 1e-5);
        const Floats b = aovs(begin + "\"mist\"\n", h, {"mist"});
        EXPECT_EQ(b, (Floats{7, 8, 9})); // that of the surface comes first
    }
}

// Zero is a value: what a shader gives under a name that it makes when it runs hides what others give, and two lights do not
// overwrite each other's outputs with what they do not give.
TEST(Outputs, AZeroThatIsGivenHidesOthers) {
    writeShader("mists", "volume mists() { outputchannel(\"mist\", 3.0); Ci = Ci; Oi = Oi; }\n");
    writeShader("zeroes", "surface zeroes(string mine = \"own\";) { string n = (xcomp(P) > 1000) ? \"nobody\" : mine; "
                          "outputchannel(n, 0.0); Oi = 1; Ci = diffuse(faceforward(N, I)); }\n");
    writeShader("lists",
                "light lists(string mine = \"a\"; float by = 1;) { string n = (xcomp(Ps) > 1000) ? \"nobody\" : mine; float "
                "both[2] = {by, by + 1}; illuminate(point \"world\" (0, 2, 0)) { Cl = 1; outputchannel(n, both); } }\n");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        EXPECT_EQ(aovs("Atmosphere \"mists\"\nSurface \"zeroes\" \"mine\" \"mist\"\n", h, {"mist"}), (Floats{0}));
        EXPECT_EQ(aovs("Atmosphere \"mists\"\nSurface \"zeroes\" \"mine\" \"other\"\n", h, {"mist"}), (Floats{3}));
        EXPECT_EQ(aovs("LightSource \"lists\" 1 \"mine\" \"a\" \"by\" 5\nLightSource \"lists\" 2 \"mine\" \"b\" \"by\" "
                       "7\nSurface \"matte\"\n",
                       h, {"a", "b"}),
                  (Floats{5, 6, 7, 8}));
    }
}

// One name, given a float at some points and a colour at others: each point shows what it was given, a float as a grey.
TEST(Outputs, NamesOfTwoTypes) {
    writeShader("twotypes", R"(surface twotypes(float tinted = 0;) {
    string n = (xcomp(P) > 1000) ? "nobody" : "shown";
    if (tinted == 1) outputchannel(n, color(1, 2, 3));
    else outputchannel(n, 4.0);
    Oi = 1; Ci = 0;
}
)");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        EXPECT_EQ(aovs("Surface \"twotypes\" \"tinted\" 1\n", h, {"shown"}), (Floats{1, 2, 3}));
        EXPECT_EQ(aovs("Surface \"twotypes\" \"tinted\" 0\n", h, {"shown"}), (Floats{4, 4, 4}));
    }
}

// A display of a whole array and another of one of its elements: of a surface, of a light, of an atmosphere.
TEST(Outputs, AnArrayAndOneOfItsElements) {
    const std::string gives = "float list[3] = {7, 8, 9}; outputchannel(\"list\", list); ";
    writeShader("surfacelist", "surface surfacelist() { " + gives + "Oi = 1; Ci = 0; }\n");
    writeShader("lightlist", "light lightlist() { illuminate(point \"world\" (0, 2, 0)) { Cl = 1; " + gives + "} }\n");
    writeShader("airlist", "volume airlist() { " + gives + "Ci = Ci; Oi = Oi; }\n");
    for (Hider h : {Hider::Hidden, Hider::Path})
        for (const char* rib : {"Surface \"surfacelist\"\n", "LightSource \"lightlist\" 1\nSurface \"matte\"\n",
                                "Atmosphere \"airlist\"\nSurface \"constant\"\n"}) {
            EXPECT_EQ(aovs(rib, h, {"list", "list[1]"}), (Floats{7, 8, 9, 8})) << rib;
            EXPECT_EQ(aovs(rib, h, {"list[2]", "list"}), (Floats{9, 7, 8, 9})) << rib;
        }
}

// What a renderer says of itself, whole and in parts, in a surface; a value of another type or length is not given.
TEST(Outputs, WhatTheRendererSaysOfItself) {
    writeShader("whoami", R"(surface whoami() {
    string name = "", text = ""; float v[4] = {9, 9, 9, 9}, one = 5, three[3] = {8, 8, 8};
    float found = rendererinfo("renderer", name) + 2 * rendererinfo("version", v) + 4 * rendererinfo("versionstring", text);
    float wrong = rendererinfo("nothing", name) + rendererinfo("renderer", one) + rendererinfo("version", text)
        + rendererinfo("versionstring", v);
    string joined = format("%d.%d.%d", v[0], v[1], v[2]);
    Oi = 1;
    Ci = color(found, wrong + one, name == "Alpenglow" && text == joined ? v[3] + 1 : -1);
}
)");
    for (Hider h : {Hider::Hidden, Hider::Path}) {
        Scene s(inWorld("Surface \"whoami\"\n" + std::string(kFloor)), under(h));
        EXPECT_EQ(s.one(kView), Color(7, 5, 1)) << s.messages();
    }
}

// Attributes of an imager are those at the beginning of the world: what the world sets is not.
TEST(Outputs, AnImagerSeesTheAttributesAtWorldBegin) {
    writeShader("seesattributes", R"(imager seesattributes() {
    float lens = -1, missing = -1, rate = -1; color tint = -1; string who = "";
    float found = attribute("user:lens", lens) + 2 * attribute("user:later", missing) + 4 * attribute("Ri:ShadingRate", rate)
                + 8 * attribute("Ri:Color", tint) + 16 * attribute("identifier:name", who);
    Ci = found == 29 && missing == -1 && who == "camera" ? tint : color(found, missing, rate);
    alpha = lens + 10 * rate;
}
)");
    Scene s(
        "Imager \"seesattributes\"\nAttribute \"user\" \"uniform float lens\" 2\n"
        "Attribute \"identifier\" \"name\" \"camera\"\nShadingRate 4\nColor .25 .5 .75\n" +
            inWorld(std::string("Attribute \"user\" \"uniform float lens\" 7 \"uniform float later\" 8\nColor 1 1 1\n") + kFloor),
        under(Hider::Hidden));
    const float x[1] = {.5f}, y[1] = {.5f};
    float r[1] = {1}, g[1] = {1}, b[1] = {1}, a[1] = {1};
    ASSERT_TRUE(s.world->runImager(1, x, y, r, g, b, a, s.diagnostics));
    EXPECT_EQ(s.diagnostics.errors() + s.diagnostics.warnings(), 0) << s.messages();
    EXPECT_EQ(Color(r[0], g[0], b[0]), Color(.25f, .5f, .75f));
    EXPECT_EQ(a[0], 42);
}

// A light and a surface in a file that is named after neither, or of which one has the name: a request means the one of its kind.
TEST(Outputs, AFileWithShadersOfSeveralKinds) {
    writeShader("pair", "surface first() { Oi = 1; Ci = diffuse(faceforward(N, I)); }\nlight second() { solar(vector \"world\" "
                        "(0, -1, 0), 0) { Cl = color(1, 2, 3); } }\n");
    Scene s(inWorld(std::string("LightSource \"pair\" 1\nSurface \"pair\"\n") + kFloor), under(Hider::Hidden));
    EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
    EXPECT_EQ(s.one(kView), Color(1, 2, 3));
}

// Arrays of co-shaders: by element, as a whole, their length, through getvar(); of two that a handle can mean.
TEST(Outputs, ArraysOfCoShaders) {
    writeShader("table", "class table(float tab[3] = {1, 2, 3}; color tones[2] = {0, 0}; float open[] = {5, 6}; color tint = "
                         "color(.25, .5, .75); string __category = \"t\";) {\n"
                         "    public float made[4] = {0, 0, 0, 0};\n    public void begin() { made[3] = tab[0] + 100; }\n}\n");
    writeShader("readstable", R"(class readstable(float what = 0;) {
    public void surface(output color Ci, Oi) {
        shader a = getshader("one"), all[] = getshaders("category", "t");
        float z[3] = a->tab, y[] = a->open, i, sum = 0, w[2] = {0, 0}, long[5] = {9, 9, 9, 9, 9}, n = 0;
        color c[2] = {0, 0};
        for (i = 0; i < arraylength(all); i += 1) { shader s = all[i]; sum += s->tab[2] * (i + 1); }
        float found = getvar(a, "tab", z) + getvar(a, "tab", w) + getvar(a, "tones", c);
        float wrong = getvar(a, "tab", long) + getvar(a, "tab", n) + getvar(a, "tones", w);
        color second = a->tones[1];
        Oi = 1;
        if (what == 0) Ci = color(z[0] + 10 * z[1] + 100 * z[2], arraylength(y) + 10 * arraylength(a->tab), sum);
        else if (what == 1) Ci = color(found + 10 * wrong, w[1], a->tab[1] + a->made[3]);
        else if (what == 2) Ci = second + c[1];
        else Ci = color(a->tint[1], y[1], long[4]);
    }
}
)");
    const std::string two =
        "Shader \"table\" \"one\" \"float tab[3]\" [4 5 6] \"color tones[2]\" [1 1 1 .1 .2 .3]\nShader \"table\" \"two\"\n";
    auto of = [&](const char* what) {
        Scene s(inWorld(two + "Surface \"readstable\" \"what\" " + what + "\n" + kFloor), under(Hider::Hidden));
        EXPECT_EQ(s.diagnostics.warnings(), 0) << s.messages();
        return s.one(kView);
    };
    EXPECT_EQ(of("0"), Color(654, 32, 6 + 2 * 3));
    EXPECT_EQ(of("1"), Color(3, 5, 5 + 104));
    const Color c = of("2");
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(c[k], .2f * float(k + 1), 1e-6);
    EXPECT_EQ(of("3"), Color(.5f, 6, 9));
}

// Arrays of the light of the turn and of lights by handle; growing arrays take as many as there are.
TEST(Outputs, ArraysOfLightsAndVolumes) {
    writeShader("rows", "light rows(float w[3] = {1, 2, 3}; output varying float out[2] = {0, 0};) { illuminate(point \"world\" "
                        "(0, 2, 0)) { Cl = 1; out[1] = 40 + w[0]; } }\n");
    writeShader("dense", "volume dense(float layers[2] = {7, 8}; string names[2] = {\"a\", \"b\"};) { Ci = Ci; Oi = Oi; }\n");
    writeShader("asksrows", R"(float exterior() {
    float l[2] = {0, 0}, o[] = {};
    string n[2] = {"", ""};
    float found = incident("layers", l) + incident("layers", o) + incident("names", n);
    return found == 3 && l[1] == 8 && arraylength(o) == 2 && n[1] == "b" ? 3 : 0;
}
surface asksrows() {
    float w[3] = {0, 0, 0}, more[] = {}, out[2] = {0, 0}, found = 0;
    illuminance(P) found += lightsource("w", w) + lightsource("w", more) + lightsource("out", out);
    shader lights[] = getlights();
    shader s = lights[0];
    float h[3] = s->w;
    float v[3] = {0, 0, 0};
    found += getvar(s, "w", v) + exterior();
    Oi = 1;
    Ci = color(found, w[2] + 10 * arraylength(more) + 100 * out[1], h[0] + 10 * v[1]);
}
)");
    Scene s(inWorld(std::string("LightSource \"rows\" 1 \"float w[3]\" [5 6 7]\nExterior \"dense\"\nSurface \"asksrows\"\n") +
                    kFloor),
            under(Hider::Hidden));
    EXPECT_EQ(s.one(kView), Color(3 + 1 + 3, 7 + 30 + 4500, 5 + 60));
}

// getvar(null, ...): numbers, arrays and texts of the primitive, by names that are made when the shader runs too; a light asks
// for its own geometry.
TEST(Outputs, VariablesOfThePrimitive) {
    writeShader("asksvars", R"(surface asksvars(float what = 0;) {
    string s = "", names[2] = {"weight", "nosuch"};
    uniform string u = "";
    float pair[2] = {0, 0}, open[] = {}, st[2] = {0, 0}, w = 0, n = 5, i;
    float found = getvar(null, "label", s) + getvar(null, "label", u) + getvar(null, "pair", pair) + getvar(null, "pair", open)
        + getvar(null, "st", st) + getvar(null, "label");
    for (i = 0; i < 2; i += 1) found += 10 * getvar(null, names[i], w);
    point q = 0;
    found += 100 * getvar(null, "P", q)
        + 1000 * (getvar(null, "label", n) + getvar(null, "pair", n) + getvar(null, "nosuch", pair));
    Oi = 1;
    if (what == 0) Ci = color(found, s == "here" && u == "here" ? 1 : 0, w);
    else if (what == 1) Ci = color(pair[0] + 10 * pair[1], arraylength(open) + 10 * open[1], distance(q, P));
    else Ci = color(st[0], st[1], n);
}
)");
    const std::string floor = "Polygon \"P\" [-60 0 -60  -60 0 60  60 0 60  60 0 -60] \"uniform string label\" [\"here\"] "
                              "\"constant float weight\" [4] \"constant float[2] pair\" [2 3] \"st\" [0 0 0 1 1 1 1 0]\n";
    auto of = [&](const char* what) {
        return Scene(inWorld(std::string("Surface \"asksvars\" \"what\" ") + what + "\n" + floor), under(Hider::Hidden))
            .one(kView);
    };
    EXPECT_EQ(of("0"), Color(6 + 10 + 100, 1, 4));
    EXPECT_EQ(of("1"), Color(32, 2 + 30, 0));
    const Color st = of("2");
    EXPECT_NEAR(st.x, .5f, 1e-5);
    EXPECT_NEAR(st.y, .5f, 1e-5);
    EXPECT_EQ(st.z, 5);
}

// An imager has the co-shaders that there are before the world begins, and asks for options.
TEST(Outputs, ImagersHaveCoShaders) {
    writeShader("grade", "class grade(color by = color(1, 2, 4);) { public void tone(output color c) { c *= by; } }\n");
    writeShader("graded", R"(imager graded() {
    shader g = getshader("look"), none = getshader("later");
    uniform float format[3] = {0, 0, 0}, frame = -1, x = 3;
    string name = "";
    float found = option("Format", format) + option("Frame", frame) + rendererinfo("renderer", name)
        + 10 * attribute("user:nobody", x) + 10 * getvar(null, "P", x);
    color c = Ci;
    g->tone(c);
    Ci = found == 3 && none == null && name == "Alpenglow" && shadername() == "graded" ? c : 0;
    alpha = format[0];
}
)");
    Scene s("Format 40 30 1\nShader \"grade\" \"look\" \"color by\" [2 3 5]\nImager \"graded\"\n" +
                inWorld(std::string("Shader \"grade\" \"later\"\n") + kFloor),
            under(Hider::Hidden));
    const float x[1] = {.5f}, y[1] = {.5f};
    float r[1] = {1}, g[1] = {1}, b[1] = {1}, a[1] = {1};
    ASSERT_TRUE(s.world->runImager(1, x, y, r, g, b, a, s.diagnostics));
    EXPECT_EQ(s.diagnostics.errors(), 0) << s.messages();
    EXPECT_EQ(Color(r[0], g[0], b[0]), Color(2, 3, 5));
    EXPECT_EQ(a[0], 40);
}

// The picture is an imager's surface and a pixel its footprint: derivatives and filterstep() know both.
TEST(Outputs, ImagersHaveDerivatives) {
    writeShader("stepped", R"(imager stepped() {
    vector across = Du(P), down = Dv(P);
    float sizes = xcomp(across) + 100 * ycomp(down) + 10000 * (xcomp(down) + ycomp(across));
    Ci = color(filterstep(10, xcomp(P), "filter", "box"), filterstep(.5, t, "filter", "box", "width", 2),
               area(P) + Deriv(u * u, u) - 2 * u - Dv(u) + Deriv(s, v));
    alpha = sizes;
}
)");
    Scene s("Format 40 30 1\nImager \"stepped\"\n" + inWorld(kFloor), under(Hider::Hidden));
    const float x[3] = {9.75f, 10.25f, 30.5f}, y[3] = {15.25f, 14.5f, 3.5f};
    float r[3] = {1, 1, 1}, g[3] = {1, 1, 1}, b[3] = {1, 1, 1}, a[3] = {1, 1, 1};
    ASSERT_TRUE(s.world->runImager(3, x, y, r, g, b, a, s.diagnostics));
    EXPECT_EQ(s.diagnostics.errors(), 0) << s.messages();
    const float red[3] = {.25f, .75f, 1}, green[3] = {.625f, .25f, 0};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(r[i], red[i], 1e-5) << i;
        EXPECT_NEAR(g[i], green[i], 1e-5) << i;
        EXPECT_NEAR(b[i], 1, 1e-5) << i;
        EXPECT_NEAR(a[i], 3040, 1e-3) << i;
    }
}

// The method of a class is an imager too, and finds the same co-shaders.
TEST(Outputs, AClassIsAnImager) {
    writeShader("grade", "class grade(color by = color(1, 2, 4);) { public void tone(output color c) { c *= by; } }\n");
    writeShader("classed", "class classed(float gain = 2;) { public void imager(output varying color Ci, Oi) { shader g = "
                           "getshader(\"look\"); g->tone(Ci); Ci *= gain; } }\n");
    Scene s("Shader \"grade\" \"look\"\nImager \"classed\" \"gain\" 3\n" + inWorld(kFloor), under(Hider::Hidden));
    const float x[1] = {.5f}, y[1] = {.5f};
    float r[1] = {1}, g[1] = {1}, b[1] = {1}, a[1] = {1};
    ASSERT_TRUE(s.world->runImager(1, x, y, r, g, b, a, s.diagnostics));
    EXPECT_EQ(s.diagnostics.errors(), 0) << s.messages();
    EXPECT_EQ(Color(r[0], g[0], b[0]), Color(3, 6, 12));
}

// Published imagers put a colour behind the picture and say Oi = 1, without a word on alpha: the mean of Oi is the alpha then.
TEST(Outputs, WhatAnImagerMakesOpaqueHasAlpha) {
    writeShader("opaque",
                "imager opaque(color behind = color(0, 0, 1);) { Ci += (1 - alpha) * behind; Oi = color(.25, .5, 1); }\n");
    writeShader(
        "opaqueclass",
        "class opaqueclass() { public void imager(output varying color Ci, Oi) { Ci += (1 - Oi) * color(0, 0, 1); Oi = 1; } }\n");
    writeShader("bothways", "imager bothways() { Oi = 1; alpha = .125; }\n");
    writeShader("neither", "imager neither() { Ci *= Oi; }\n");
    writeShader("someopaque", "imager someopaque() { if (alpha > .5) Oi = 1; }\n");
    const std::pair<const char*, std::pair<float, float>> all[] = {{"opaque", {1.75f / 3, 1.75f / 3}},
                                                                   {"opaqueclass", {1, 1}},
                                                                   {"bothways", {.125f, .125f}},
                                                                   {"neither", {.25f, .75f}},
                                                                   {"someopaque", {.25f, 1}}};
    for (const auto& [name, wanted] : all) {
        Scene s("Imager \"" + std::string(name) + "\"\n" + inWorld(kFloor), under(Hider::Hidden));
        const float x[2] = {.5f, 1.5f}, y[2] = {.5f, .5f};
        float r[2] = {.5f, .5f}, g[2] = {0, 0}, b[2] = {0, 0}, a[2] = {.25f, .75f};
        ASSERT_TRUE(s.world->runImager(2, x, y, r, g, b, a, s.diagnostics)) << name;
        EXPECT_EQ(s.diagnostics.errors() + s.diagnostics.warnings(), 0) << s.messages();
        EXPECT_FLOAT_EQ(a[0], wanted.first) << name;
        EXPECT_FLOAT_EQ(a[1], wanted.second) << name;
        EXPECT_FLOAT_EQ(b[0], std::string(name).starts_with("opaque") ? .75f : 0.f) << name;
    }
}

// attribute(): a value of another type or size is no answer; a single number converts to a colour as in the language.
TEST(Outputs, AttributesOfAnotherTypeAreNotTold) {
    writeShader("askswrong", R"(surface askswrong() {
    float f = 5, two[2] = {6, 6}; string s = "kept"; color c = 7, sides = 7; matrix m = 1;
    float found = attribute("Ri:Color", f) + attribute("Ri:ShadingRate", s) + attribute("identifier:name", f)
        + option("Ri:Format", f) + attribute("Ri:Color", m);
    float right = attribute("Ri:DetailRange", two) + attribute("Ri:Color", c) + attribute("Ri:Sides", sides);
    Oi = 1; Ci = color(found * 10 + right, f, s == "kept" && sides == 2 ? comp(c, 1) : -1);
}
)");
    Scene s(inWorld(std::string("Color .25 .5 1\nSurface \"askswrong\"\n") + kFloor), under(Hider::Hidden));
    EXPECT_EQ(s.one(kView), Color(3, 5, .5f));
}

} // namespace

} // namespace outputs_test

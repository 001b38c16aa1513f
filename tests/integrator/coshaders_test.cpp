// RIB Shader: co-shaders of a shape, by their handles; a class that is a surface and a displacement. Closed forms.
#include "integrator/harness.h"

namespace coshaders_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

void writeLayers() {
    writeShader("tintlayer", "class tintlayer(color tint = color(1, 0, 0); string __category = \"tint\";) {\n"
                             "    public void add(output color c; float k) { c += tint * k; }\n}\n");
    writeShader("layered",
                "class layered() {\n    public void surface(output color Ci, Oi) {\n        shader all[] = getshaders();\n"
                "        float i; Oi = 1; Ci = 0;\n        for (i = 0; i < arraylength(all); i += 1) all[i]->add(Ci, i + 1);\n   "
                " }\n}\n");
}

TEST(CoShaders, OfTheShapeByTheirHandles) {
    writeLayers();
    Scene s(std::string("WorldBegin\nSurface \"layered\"\nShader \"tintlayer\" \"a\"\nShader \"tintlayer\" \"b\" \"color tint\" "
                        "[0 .25 .5]\n") +
            kSquare + "WorldEnd\n");
    // Once red, twice (0, .25, .5).
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, .5f);
    EXPECT_FLOAT_EQ(c.z, 1);
}

TEST(CoShaders, EachShapeHasItsOwn) {
    writeLayers();
    Scene s(std::string("WorldBegin\nSurface \"layered\"\nAttributeBegin\nShader \"tintlayer\" \"a\" \"color tint\" [0 0 "
                        "1]\nTranslate -1.5 0 0\n") +
            kSquare + "AttributeEnd\nAttributeBegin\nShader \"tintlayer\" \"a\" \"color tint\" [0 1 0]\nTranslate 1.5 0 0\n" +
            kSquare + "AttributeEnd\nTranslate 0 3 0\n" + kSquare + "WorldEnd\n");
    EXPECT_FLOAT_EQ(s.one(rayTo({0, 0, 0}, {-1.5f, 0, 2})).z, 1);
    EXPECT_FLOAT_EQ(s.one(rayTo({0, 0, 0}, {1.5f, 0, 2})).y, 1);
    const Color none = s.one(rayTo({0, 0, 0}, {0, 3, 2}));
    EXPECT_FLOAT_EQ(none.x + none.y + none.z, 0);
}

TEST(CoShaders, AClassDisplacesWhatItShades) {
    writeShader(
        "pushed",
        "class pushed(float by = 1;) {\n"
        "    public void displacement(output point P; output normal N) { P = transform(\"world\", \"current\", "
        "transform(\"world\", P) + vector(0, 0, -by)); N = calculatenormal(P); }\n"
        "    public void surface(output color Ci, Oi) { Oi = 1; Ci = color(zcomp(transform(\"world\", P)), 0, 0); }\n}\n");
    Scene s(std::string("WorldBegin\nShadingRate 64\nAttribute \"displacementbound\" \"float sphere\" [1]\nSurface \"pushed\" "
                        "\"float by\" [.5]\n") +
            kSquare + "WorldEnd\n");
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.1f, .2f, 1.5f})).x, 1.5f, 1e-3);
}

} // namespace

namespace {

/// add(c, k) by another kind of shader than a surface: both shaders below find "a" and "b".
const char* kTwo = "Shader \"tintlayer\" \"a\"\nShader \"tintlayer\" \"b\" \"color tint\" [0 .25 .5]\n";

void expectBoth(const Color& c) { // once red, twice (0, .25, .5)
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, .5f);
    EXPECT_FLOAT_EQ(c.z, 1);
}

} // namespace

TEST(CoShaders, OfALight) {
    writeLayers();
    writeShader("layeredlight", "light layeredlight() {\n    shader all[] = getshaders();\n    float i; color c = 0;\n"
                                "    for (i = 0; i < arraylength(all); i += 1) all[i]->add(c, i + 1);\n    solar(vector "
                                "\"world\" (0, 0, 1), 0) Cl = c;\n}\n");
    writeShader("lightsum", "surface lightsum() { Ci = 0; illuminance(P) Ci += Cl; Oi = 1; }\n");
    Scene s(std::string("WorldBegin\n") + kTwo + "LightSource \"layeredlight\" 1\nSurface \"lightsum\"\n" + kSquare +
            "WorldEnd\n");
    expectBoth(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})));
}

TEST(CoShaders, OfAnAtmosphere) {
    writeLayers();
    writeShader("layeredair", "volume layeredair() {\n    shader all[] = getshaders();\n    float i;\n    Ci = 0; Oi = 1;\n"
                              "    for (i = 0; i < arraylength(all); i += 1) all[i]->add(Ci, i + 1);\n}\n");
    Scene s(std::string("WorldBegin\n") + kTwo + "Atmosphere \"layeredair\"\nSurface \"constant\"\n" + kSquare + "WorldEnd\n");
    expectBoth(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})));
}

TEST(CoShaders, OfADisplacement) {
    // A co-shader of a kind of its own: a class with nothing but a displacement is one as well.
    writeShader("lift", "class lift(float by = 1;) {\n    public float amount(float k) { return by * k; }\n"
                        "    public void displacement(output point P; output normal N) { P += amount(1) * normalize(N); }\n}\n");
    writeShader("lifted", "displacement lifted() {\n    shader h = getshader(\"up\");\n"
                          "    P = transform(\"world\", \"current\", transform(\"world\", P) + vector(0, 0, -h->amount(2)));\n   "
                          " N = calculatenormal(P);\n}\n");
    writeShader("height", "surface height() { Oi = 1; Ci = zcomp(transform(\"world\", P)); }\n");
    Scene s(std::string("WorldBegin\nShader \"lift\" \"up\" \"float by\" [.25]\nDisplacement \"lifted\"\nSurface \"height\"\n") +
            kSquare + "WorldEnd\n");
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.1f, .2f, 1.5f})).x, 1.5f, 1e-3);
}

TEST(DisplacementBound, ShadersSayTheirOwn) {
    writeShader("boundlift", "displacement boundlift(float by = .5; float __displacementbound_sphere = 1; string "
                             "__displacementbound_coordinatesystem = \"world\";) {\n"
                             "    P = transform(\"world\", \"current\", transform(\"world\", P) + vector(0, 0, -by));\n    N = "
                             "calculatenormal(P);\n}\n");
    writeShader("boundheight", "surface boundheight(float __displacementbound_sphere = 0;) { Oi = 1; Ci = 1; }\n");
    const auto warned = [](const std::string& rib) {
        Scene s("Format 32 32 1\nWorldBegin\n" + rib + kSquare + "WorldEnd\n");
        return s.messages().find("beyond its displacementbound") != std::string::npos;
    };
    const std::string surface = "Surface \"boundheight\"\n";
    // Half a unit goes beyond .3, but not beyond 1, nor .3 of the shader and .3 of the attribute, nor .3 and .3 of two shaders.
    EXPECT_FALSE(warned("Displacement \"boundlift\"\n" + surface));
    EXPECT_TRUE(warned("Displacement \"boundlift\" \"float __displacementbound_sphere\" .3\n" + surface));
    EXPECT_FALSE(warned(
        "Attribute \"displacementbound\" \"sphere\" .3\nDisplacement \"boundlift\" \"float __displacementbound_sphere\" .3\n" +
        surface));
    EXPECT_FALSE(warned("Displacement \"boundlift\" \"float __displacementbound_sphere\" .3\nSurface \"boundheight\" \"float "
                        "__displacementbound_sphere\" .3\n"));
    // The space is the displacement's: in that of an object three times as large .3 are .9, but not along the axis that is as it
    // was.
    const std::string ofObject = "Displacement \"boundlift\" \"float __displacementbound_sphere\" .3 \"string "
                                 "__displacementbound_coordinatesystem\" \"object\"\n";
    EXPECT_FALSE(warned("Scale 3 3 3\n" + ofObject + surface));
    EXPECT_TRUE(warned("Scale 3 3 1\n" + ofObject + surface));
}

TEST(CoShaders, ArraysOfHandlesAndOfTexts) {
    writeLayers();
    writeShader("chosen",
                "surface chosen(shader use[3] = {null, null, null}; string words[2] = {\"\", \"\"}; string defaults[2] = {\"x\", "
                "\"yes\"};) {\n"
                "    float i; Oi = 1; Ci = 0;\n    for (i = 0; i < 3; i += 1) if (use[i] != null) use[i]->add(Ci, i + 1);\n"
                "    if (words[1] != \"second\" || words[0] != \"first\" || defaults[1] != \"yes\") Ci = -1;\n}\n");
    Scene s(std::string("WorldBegin\n") + kTwo +
            "Surface \"chosen\" \"string use[3]\" [\"\" \"b\" \"a\"] \"string words[2]\" [\"first\" \"second\"]\n" + kSquare +
            "WorldEnd\n");
    // Twice (0, .25, .5), three times red.
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_FLOAT_EQ(c.x, 3);
    EXPECT_FLOAT_EQ(c.y, .5f);
    EXPECT_FLOAT_EQ(c.z, 1);
}

TEST(CoShaders, AskingThePrimitive) {
    writeShader("asks", "surface asks() {\n    float w = 7; color c = 7; Oi = 1;\n    float a = getvar(null, \"weight\", w), b = "
                        "getvar(null, \"absent\", w), d = getvar(null, \"tone\", c);\n"
                        "    Ci = color(w, a + 10 * b + 100 * d, c[1]);\n}\n");
    Scene s("WorldBegin\nSurface \"asks\"\nPolygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2] \"varying float weight\" [1 1 1 1] "
            "\"uniform color tone\" [0 .25 1]\nWorldEnd\n");
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, 101);
    EXPECT_FLOAT_EQ(c.z, .25f);
}

} // namespace coshaders_test

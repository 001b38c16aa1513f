// RIB Shader: co-shaders of a shape, by their handles; a class that is a surface and a displacement. Closed forms.
#include "transport/harness.h"

using namespace alpenglow;
using namespace alpenglow::transport;
using namespace alpenglow::transport::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

void writeLayers() {
    writeShader("tintlayer", "class tintlayer(color tint = color(1, 0, 0); string __category = \"tint\";) {\n"
                             "    public void add(output color c; float k) { c += tint * k; }\n}\n");
    writeShader("layered", "class layered() {\n    public void surface(output color Ci, Oi) {\n        shader all[] = getshaders();\n"
                           "        float i; Oi = 1; Ci = 0;\n        for (i = 0; i < arraylength(all); i += 1) all[i]->add(Ci, i + 1);\n    }\n}\n");
}

TEST(CoShaders, OfTheShapeByTheirHandles) {
    writeLayers();
    Scene s(std::string("WorldBegin\nSurface \"layered\"\nShader \"tintlayer\" \"a\"\nShader \"tintlayer\" \"b\" \"color tint\" [0 .25 .5]\n") +
            kSquare + "WorldEnd\n");
    // Once red, twice (0, .25, .5).
    const Color c = s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
    EXPECT_FLOAT_EQ(c.x, 1);
    EXPECT_FLOAT_EQ(c.y, .5f);
    EXPECT_FLOAT_EQ(c.z, 1);
}

TEST(CoShaders, EachShapeHasItsOwn) {
    writeLayers();
    Scene s(std::string("WorldBegin\nSurface \"layered\"\nAttributeBegin\nShader \"tintlayer\" \"a\" \"color tint\" [0 0 1]\nTranslate -1.5 0 0\n") + kSquare +
            "AttributeEnd\nAttributeBegin\nShader \"tintlayer\" \"a\" \"color tint\" [0 1 0]\nTranslate 1.5 0 0\n" + kSquare +
            "AttributeEnd\nTranslate 0 3 0\n" + kSquare + "WorldEnd\n");
    EXPECT_FLOAT_EQ(s.one(rayTo({0, 0, 0}, {-1.5f, 0, 2})).z, 1);
    EXPECT_FLOAT_EQ(s.one(rayTo({0, 0, 0}, {1.5f, 0, 2})).y, 1);
    const Color none = s.one(rayTo({0, 0, 0}, {0, 3, 2}));
    EXPECT_FLOAT_EQ(none.x + none.y + none.z, 0);
}

TEST(CoShaders, AClassDisplacesWhatItShades) {
    writeShader("pushed", "class pushed(float by = 1;) {\n"
                          "    public void displacement(output point P; output normal N) { P = transform(\"world\", \"current\", transform(\"world\", P) + vector(0, 0, -by)); N = calculatenormal(P); }\n"
                          "    public void surface(output color Ci, Oi) { Oi = 1; Ci = color(zcomp(transform(\"world\", P)), 0, 0); }\n}\n");
    Scene s(std::string("WorldBegin\nAttribute \"displacementbound\" \"float sphere\" [1]\nSurface \"pushed\" \"float by\" [.5]\n") + kSquare + "WorldEnd\n");
    EXPECT_NEAR(s.one(rayTo({0, 0, 0}, {.1f, .2f, 1.5f})).x, 1.5f, 1e-3);
}

} // namespace

// Parameters whose arrays are of open length, `float w[] = {}`: as long as what the scene gives. Closed forms.
#include "integrator/harness.h"

namespace openarrays_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

const char* kSquare = "Polygon \"P\" [-1 -1 2  1 -1 2  1 1 2  -1 1 2]\n";

void writeOpen() {
    // How many texts, how many numbers, and the sum of the numbers; the last text counts when it is "end".
    writeShader("openarrays",
                "surface openarrays(string maps[] = {}; float w[] = {}; color tints[] = {color(0, 0, 1)};) {\n"
                "    float sum = 0, i; for (i = 0; i < arraylength(w); i += 1) sum += w[i];\n"
                "    float end = 0; if (arraylength(maps) > 0) { if (maps[arraylength(maps) - 1] == \"end\") end = 100; }\n"
                "    color all = 0; for (i = 0; i < arraylength(tints); i += 1) all += tints[i];\n"
                "    Ci = color(arraylength(maps) + 10 * arraylength(w) + end, sum, 10 * arraylength(tints) + comp(all, 2)); Oi "
                "= 1; }\n");
}

Color of(const std::string& given) {
    writeOpen();
    Scene s("WorldBegin\nSurface \"openarrays\" " + given + "\n" + kSquare + "WorldEnd\n");
    return s.one(rayTo({0, 0, 0}, {.2f, .3f, 2}));
}

TEST(OpenArrays, AreAsLongAsWhatIsGiven) {
    EXPECT_EQ(of(""), Color(0, 0, 11));
    EXPECT_EQ(of("\"uniform string[3] maps\" [\"a\" \"b\" \"end\"]"), Color(103, 0, 11));
    EXPECT_EQ(of("\"uniform float[2] w\" [3 4]"), Color(20, 7, 11));
    EXPECT_EQ(of("\"uniform float[5] w\" [1 2 3 4 5] \"uniform string[1] maps\" [\"a\"]"), Color(51, 15, 11));
    EXPECT_EQ(of("\"uniform color[3] tints\" [0 0 .5 0 0 .25 0 0 2]"), Color(0, 0, 32.75f));
}

TEST(OpenArrays, WithoutADeclarationInTheScene) {
    EXPECT_EQ(of("\"w\" [1 2 3]"), Color(30, 6, 11));
    EXPECT_EQ(of("\"maps\" [\"a\" \"b\"]"), Color(2, 0, 11));
}

// Two surfaces of one shader with arrays of different lengths do not share code that knows one of them.
TEST(OpenArrays, EachInstanceHasItsOwn) {
    writeOpen();
    Scene s(std::string("WorldBegin\nAttributeBegin\nSurface \"openarrays\" \"uniform float[2] w\" [3 4]\nTranslate -1.5 0 0\n") +
            kSquare +
            "AttributeEnd\nAttributeBegin\nSurface \"openarrays\" \"uniform float[4] w\" [1 1 1 1]\nTranslate 1.5 0 0\n" +
            kSquare + "AttributeEnd\nWorldEnd\n");
    EXPECT_EQ(s.one(rayTo({0, 0, 0}, {-1.5f, 0, 2})), Color(20, 7, 11));
    EXPECT_EQ(s.one(rayTo({0, 0, 0}, {1.5f, 0, 2})), Color(40, 4, 11));
}

TEST(OpenArrays, OfCoShaders) {
    writeShader("openlayer", "class openlayer(float w[] = {}; string names[] = {};) {\n    public void ask(output color c) { c = "
                             "color(arraylength(w), w[arraylength(w) - 1], arraylength(names)); }\n}\n");
    writeShader("openasks", "class openasks() {\n    public void surface(output color Ci, Oi) { shader l = getshader(\"a\"); Oi "
                            "= 1; l->ask(Ci); }\n}\n");
    Scene s(std::string("WorldBegin\nSurface \"openasks\"\nShader \"openlayer\" \"a\" \"uniform float[3] w\" [5 6 7] \"uniform "
                        "string[2] names\" [\"x\" \"y\"]\n") +
            kSquare + "WorldEnd\n");
    EXPECT_EQ(s.one(rayTo({0, 0, 0}, {.2f, .3f, 2})), Color(3, 7, 2));
    Scene none(std::string("WorldBegin\nSurface \"openasks\"\nShader \"openlayer\" \"a\"\n") + kSquare + "WorldEnd\n");
    EXPECT_EQ(none.one(rayTo({0, 0, 0}, {.2f, .3f, 2})), Color(0, 0, 0));
}

} // namespace

} // namespace openarrays_test

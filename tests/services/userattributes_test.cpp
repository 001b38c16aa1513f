// Attribute "user" and Option "user" in shaders: every type, the conversions of the shading language, every kind of shader. What
// is expected is what the scene says.
#include "integrator/floorscene.h"

namespace userattributes_test {

using namespace alpenglow;
using namespace alpenglow::integrator;
using namespace alpenglow::integrator::testing;

namespace {

constexpr const char* kValues =
    "\"float f\" [.5] \"float[3] list\" [1 2 3] \"string s\" [\"a b\"] \"string[2] words\" [\"x\" \"y\"] \"color c\" [.1 .2 .3]\n"
    "    \"point p\" [1 2 3] \"vector v\" [4 5 6] \"normal n\" [7 8 9] \"int i\" [7] \"color[2] tones\" [1 2 3 4 5 6]\n"
    "    \"matrix m\" [1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16] \"uniform hpoint h\" [1 2 3 4]\n";

struct Question {
    const char *variable, *name, *holds; ///< holds: of the variable v, after the call found a value
};

constexpr Question kFound[] = {{"float v = -1", "f", "v == .5"},
                               {"float v = -1", "i", "v == 7"},
                               {"float v[3] = {-1, -1, -1}", "list", "v[0] == 1 && v[1] == 2 && v[2] == 3"},
                               {"uniform float v[]", "list", "arraylength(v) == 3 && v[2] == 3"},
                               {"string v = \"\"", "s", "v == \"a b\""},
                               {"string v[2] = {\"\", \"\"}", "words", "v[0] == \"x\" && v[1] == \"y\""},
                               {"color v = -1", "c", "v == color(.1, .2, .3)"},
                               {"color v[2] = {-1, -1}", "tones", "v[0] == color(1, 2, 3) && v[1] == color(4, 5, 6)"},
                               {"point v = -1", "p", "v == point(1, 2, 3)"},
                               {"vector v = -1", "v", "v == vector(4, 5, 6)"},
                               {"normal v = -1", "n", "v == normal(7, 8, 9)"},
                               {"matrix v = -1", "m", "comp(v, 0, 1) == 2 && comp(v, 3, 0) == 13 && comp(v, 3, 3) == 16"},
                               {"float v[4] = {-1, -1, -1, -1}", "h", "v[0] == 1 && v[3] == 4"},
                               // Conversions: the same numbers, or one number for all components as the language has it.
                               {"float v[3] = {-1, -1, -1}", "c", "v[0] == .1 && v[2] == .3"},
                               {"color v = -1", "list", "v == color(1, 2, 3)"},
                               {"color v = -1", "p", "v == color(1, 2, 3)"},
                               {"float v[16]", "m", "v[1] == 2 && v[15] == 16"},
                               {"color v = -1", "f", "v == color(.5, .5, .5)"},
                               {"point v = -1", "i", "v == point(7, 7, 7)"},
                               {"matrix v = -1", "i", "v == matrix 7 && comp(v, 3, 3) == 7 && comp(v, 0, 1) == 0"}};

/// What does not fit leaves the variable alone.
constexpr Question kNotFound[] = {{"float v = -1", "c", "v == -1"},
                                  {"float v = -1", "s", "v == -1"},
                                  {"string v = \"-\"", "f", "v == \"-\""},
                                  {"color v = -1", "words", "v == color(-1, -1, -1)"},
                                  {"color v = -1", "m", "v == color(-1, -1, -1)"},
                                  {"color v[2] = {-1, -1}", "f", "v[1] == color(-1, -1, -1)"},
                                  {"float v = -1", "nobody", "v == -1"}};

/// Wrong answers of `call` ("attribute", "option") in a scene where `rib` sets the values.
float wrong(const std::string& call, const std::string& before, const std::string& inside) {
    std::string body;
    int k = 0;
    const auto ask = [&](const Question& q, int found) {
        std::string variable = q.variable, holds = q.holds;
        const std::string own = "v" + std::to_string(k++);
        const auto rename = [&](std::string& text) {
            for (size_t at = 0; (at = text.find('v', at)) != text.npos; ++at) {
                const auto letter = [&](size_t i) {
                    return i < text.size() && std::isalpha(static_cast<unsigned char>(text[i]));
                };
                if ((at == 0 || !letter(at - 1)) && !letter(at + 1)) text.replace(at, 1, own);
            }
        };
        rename(variable);
        rename(holds);
        body += "    " + variable + ";\n    if (" + call + "(\"user:" + q.name + "\", " + own + ") != " + std::to_string(found) +
                " || !(" + holds + ")) { wrong += 1; printf(\"" + q.name + " in " + own + "\\n\"); }\n";
    };
    for (const Question& q : kFound) ask(q, 1);
    for (const Question& q : kNotFound) ask(q, 0);
    const std::string shader = "users" + call;
    writeShader(shader, "surface " + shader + "() {\n    float wrong = 0;\n" + body + "    Oi = 1;\n    Ci = wrong;\n}\n");
    Scene s(before + "WorldBegin\nSides 2\n" + inside + "Surface \"" + shader + "\"\n" + kFloor + "WorldEnd\n",
            under(Hider::Raytrace));
    EXPECT_EQ(s.diagnostics.errors(), 0) << s.messages();
    return s.one(kView).x;
}

} // namespace

TEST(UserAttributes, EveryTypeAndItsConversions) {
    EXPECT_EQ(wrong("attribute", "", std::string("Attribute \"user\" ") + kValues), 0);
    EXPECT_EQ(wrong("option", std::string("Option \"user\" ") + kValues, ""), 0);
}

// Points are the numbers of the file: a shader says in which space they are.
TEST(UserAttributes, AShaderTransformsAPoint) {
    writeShader("transformsit", "surface transformsit() { point c = 0; attribute(\"user:centre\", c);\n"
                                "    c = transform(\"object\", \"current\", c); c = transform(\"current\", \"world\", c);\n"
                                "    Oi = 1; Ci = color(xcomp(c), ycomp(c), zcomp(c)); }\n");
    Scene s(std::string("WorldBegin\nSides 2\nAttribute \"user\" \"point centre\" [1 2 3]\nSurface \"transformsit\"\n") +
                "Translate 10 0 20\n" + kFloor + "WorldEnd\n",
            under(Hider::Raytrace));
    const Color c = s.one(kView);
    EXPECT_NEAR(c.x, 11, 1e-4);
    EXPECT_NEAR(c.y, 2, 1e-4);
    EXPECT_NEAR(c.z, 23, 1e-4);
}

// Lights have the value at their request, all others that of the primitive.
TEST(UserAttributes, EveryKindOfShader) {
    const std::string asks = " float x = -1, y = -1; attribute(\"user:x\", x); option(\"user:x\", y); ";
    writeShader("lightasks", "light lightasks() {" + asks + "solar(vector \"world\" (0, -1, 0), 0) Cl = x + 100 * y; }\n");
    writeShader("movesasks", "displacement movesasks(output float seen = 0;) {" + asks + "seen = x + 100 * y; }\n");
    writeShader("fogasks", "volume fogasks() {" + asks + "Ci += color(0, 0, x + 100 * y); Oi = 1; }\n");
    writeShader("surfaceasks",
                "surface surfaceasks() {" + asks +
                    "float moved = -1; displacement(\"seen\", moved);\n    Oi = 1; Ci = color(x + 100 * y, moved, 0);\n"
                    "    illuminance(P) Ci += color(0, 1000 * comp(Cl, 0), 0); }\n");
    for (Hider h : {Hider::Hidden, Hider::Raytrace}) {
        Scene s(std::string("Option \"user\" \"float x\" [1]\nWorldBegin\nSides 2\nAttribute \"user\" \"float x\" [3]\n") +
                    "LightSource \"lightasks\" 1\nAttribute \"user\" \"float x\" [5]\nDisplacement \"movesasks\"\n"
                    "Surface \"surfaceasks\"\nAtmosphere \"fogasks\"\n" +
                    kFloor + "WorldEnd\n",
                under(h));
        const Color c = s.one(kView);
        EXPECT_EQ(s.diagnostics.errors(), 0) << s.messages();
        EXPECT_FLOAT_EQ(c.x, 105);
        EXPECT_FLOAT_EQ(c.y, 105 + 103'000);
        EXPECT_FLOAT_EQ(c.z, 105);
    }
}

} // namespace userattributes_test

// OSL as RSL (rsl/front/osl.h). What it computes is tested by kernels in tests/language; here: what is taken, and what is said.
#include "rsl/front/ast.h"
#include "rsl/front/osl.h"
#include <gtest/gtest.h>

namespace osl_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

std::string messages(const Diagnostics& d) {
    std::string s;
    for (const Diagnostic& m : d.all()) s += toString(m);
    return s;
}
/// The shader that an OSL text becomes; null with its messages.
std::unique_ptr<Program> compiled(const std::string& osl, std::string* said = nullptr) {
    Diagnostics d;
    const auto rsl = front::rslFromOsl(osl, "x.osl", d);
    auto p = rsl ? compileText(*rsl, "x.osl", {}, d) : nullptr;
    if (said) *said = messages(d);
    else EXPECT_NE(p, nullptr) << messages(d) << (rsl ? *rsl : "");
    return p;
}

TEST(Osl, ParametersAndOutputsAreThoseOfTheShader) {
    auto p =
        compiled("shader band(color Cin = color(1, 0.5, 0), int n = 3, string file = \"\", float s = 0 [[int lockgeom = 0]],\n"
                 "            output color Cout = 0, output float resultF = 0)\n{ Cout = Cin * s; resultF = n; }\n");
    ASSERT_TRUE(p);
    ASSERT_EQ(p->shaders.size(), 1u);
    const Shader& s = *p->shaders[0];
    EXPECT_EQ(s.kind, ShaderKind::Surface);
    std::string names;
    for (const ShaderParameter& q : s.parameters) names += q.symbol->name + (q.symbol->output ? "! " : " ");
    EXPECT_EQ(names, "Cin n file s_ Cout! resultF! "); // s is a variable of RSL
}

TEST(Osl, ParametersThatAreBoundToThePrimitiveBeginWithItsVariables) {
    auto p = compiled(
        "shader c(color Cs = 1 [[int lockgeom=0]], float s = 0 [[string help = \"[a]\", int lockgeom = 0]], float t = 0, "
        "output color Cout = 0,) { Cout = Cs * s + t; }");
    ASSERT_TRUE(p);
    const auto rsl =
        front::rslFromOsl("shader c(color Cs = 1 [[int lockgeom = 0]], float t = .5, float v = 2 [[int lockgeom = 1]], output "
                          "color o = 0) { o = Cs; }",
                          "x.osl", *std::make_unique<Diagnostics>());
    ASSERT_TRUE(rsl);
    EXPECT_NE(rsl->find("Cs_ = Cs;"), std::string::npos) << *rsl;
    EXPECT_NE(rsl->find("t_= .5;"), std::string::npos) << *rsl;
    EXPECT_NE(rsl->find("v_= 2;"), std::string::npos) << *rsl;
}

TEST(Osl, AMissingCommaIsSaidWhereItIsMissing) {
    const std::pair<const char*, const char*> all[] = {
        {"shader a(float x = 1\n         float y = 2, output color c = 0) { c = x; }", "x.osl:2:10"},
        {"shader a(float x float y) {}", "x.osl:1:18"},
        {"shader a(color x = color(1, 0, 0) output float r = 0) { r = 1; }", "x.osl:1:35"},
        {"float f(float x float y) { return x; }\nshader a(output float r = 0) { r = f(u, v); }", "x.osl:1:17"}};
    for (const auto& [text, place] : all) {
        std::string said;
        EXPECT_EQ(compiled(text, &said), nullptr) << text;
        EXPECT_NE(said.find(place), std::string::npos) << text << '\n' << said;
        EXPECT_NE(said.find("a comma is missing before this parameter"), std::string::npos) << said;
    }
    compiled("shader a(color x = color(float(1), 0, 0), float y = (float) noise(u) [[string help = \"float y\"]],\n output color "
             "c = 0,) "
             "{ c = x * y; }");
}

TEST(Osl, FormsThatDiffer) {
    compiled("shader a(output color c = 0) { c = (float) noise(\"uperlin\", u * 10, v * 10) * color(\"hsv\", .5, 1, 1); }");
    compiled("shader noise(output color c = 0) { c = noise(\"cell\", P); c += snoise(P); }");
    compiled(
        "float f(float x, output float y) { y = x; return 2 * x; }\nshader b(output float r = 0) { float y; r = f(u, y) + y; }");
    compiled("shader d(int n = 4, output float r = 0) { for (int i = 0; i < n; i++) { r += i / 2; } if (n > 2 and not (n == 3)) "
             "r = 1; }");
    compiled("#include \"stdosl.h\"\nshader e(output float r = 0) { vector w = cross(N, vector(0, 0, 1)); r = dot(w, I) + "
             "fmod(u, .5) + "
             "M_PI + (int) v; }");
    compiled("shader g(string f = \"\", output color c = 0, output float a = 0) { texture(f, u, v, \"firstchannel\", 1, "
             "\"alpha\", a); "
             "c = (color) texture(f, u, v); c.x = 1; }");
    compiled("shader w(output float r = 0) { float f = filterwidth(u); r = smoothstep(.5 - f, .5 + f, u) + select(0, 1, "
             "backfacing()); }");
    compiled("surface h(output color c = 0) { color t[3] = { color(1, 0, 0), color(0, 1, 0), color(0, 0, 1) }; int id; "
             "getattribute(\"builtin\", \"id\", id); c = t[id % 3]; }");
}

TEST(Osl, WhatIsNotTranslatedIsSaidWithItsPlace) {
    const std::pair<const char*, const char*> cases[] = {
        {"struct S { float x; };\nshader a(output float r = 0) { r = 1; }", "structures"},
        {"shader a(output closure color c = 0) { c = diffuse(N); }", "closures"},
        {"shader a(output color c = 0)\n{ Ci = diffuse(N); }", "closure"},
        {"shader a(int n = 1, output float r = 0) { r = n << 2; }", "bits"},
        {"shader a(output float r = 0) { r = 1; ", "bracket"},
        {"float f() { return 1; }", "no shader"},
        {"nonsense", "not expected"},
        {"", "no shader"},
    };
    for (const auto& [text, word] : cases) {
        std::string said;
        EXPECT_EQ(compiled(text, &said), nullptr) << text;
        EXPECT_NE(said.find(word), std::string::npos) << text << '\n' << said;
    }
    std::string said;
    compiled("shader a(output color c = 0)\n{\n  c = 1;\n  c = emission();\n}", &said);
    EXPECT_NE(said.find("x.osl:4:7"), std::string::npos) << said;
}

TEST(Osl, HostileTextsEndWell) {
    std::string said;
    compiled(std::string(100'000, '('), &said);
    compiled("shader a(" + std::string(50'000, '[') + "", &said);
    compiled("shader a(output float r = 0) { r = \"", &said);
    compiled("[[", &said);
    compiled("shader a(float", &said);
    compiled("shader a(output float r = 0) { r = (int", &said);
    compiled("shader a(output float r = 0) { for (int", &said);
    EXPECT_FALSE(said.empty());
}

} // namespace
} // namespace osl_test

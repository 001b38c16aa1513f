// Statements, declarations, functions and shaders (RISpec 3.2, 13.2 and section 14), and what old files do (docs/language.md).
#include "front_helpers.h"

namespace alpenglow::rsl::front_statements_test {
namespace {

struct Case {
    const char* body;
    const char* tree;
};

const Case kStatements[] = {
    {"while (f < 3) f += 1;", "(while (less:bool f 3) (+= f 1))"},
    {"for (f = 0; f < 3; f += 1) g = f;", "(for (= f 0) (less:bool f 3) (+= f 1) (= g f))"},
    {"for (;;) break;", "(for - - - (break 1))"},
    {"for (float i = 0; i < 3; i += 1) g = i;",
     "(block (declare (varying float i = 0)) (for - (less:bool i 3) (+= i 1) (= g i)))"},
    {"for (f = 0, g = 1; f < 3; f += 1, g += 2) h = f;",
     "(block (= f 0) (for (= g 1) (less:bool f 3) (then:float (+= f 1) (+= g 2)) (= h f)))"},
    {"while (1) while (1) break 2;", "(while (notequal:bool 1 0) (while (notequal:bool 1 0) (break 2)))"},
    {"while (f) { continue; }", "(while (notequal:bool f 0) (block (continue 1)))"},
    {"if (f > 1) g = 1; else g = 2;", "(if (greater:bool f 1) (= g 1) else (= g 2))"},
    {"if (f > 1) if (g > 1) h = 1; else h = 2;", "(if (greater:bool f 1) (if (greater:bool g 1) (= h 1) else (= h 2)))"},
    {";", "(block)"},
    {"{ float f = 2; g = f; }", "(block (declare (varying float f = 2)) (= g f))"},
    {"uniform float k = 2, l;", "(declare (uniform float k = 2) (uniform float l))"},
    {"float b[3] = {1, 2};", "(declare (varying float[3] b = (list:float[3] 1 2)))"},
    {"float b[2] = 0;", "(declare (varying float[2] b = (list:float[2] 0 ...)))"},
    {"color b[2] = {0, c};", "(declare (varying color[2] b = (list:color[2] (cast:color 0) c)))"},
    {"uniform float b[] = {1, 2, 3};", "(declare (uniform float[] b = (list:float[3] 1 2 3)))"},
    {"float b[2*3];", "(declare (varying float[6] b))"},
    {"a[1] = 2;", "(= (index a 1) 2)"},
    {"ca[1][2] = f;", "(= (index (index ca 1) 2) f)"},
    {"c[0] += 1;", "(+= (index c 0) 1)"},
    {"a = {1, 2, 3, 4};", "(= a (list:float[4] 1 2 3 4))"},
    {"illuminance (p) { c += Cl; }", "(illuminance p (block (+= c Cl)))"},
    {"illuminance (P, N, PI/2) c += Cl;", "(illuminance P (cast:vector N) (div:float 3.14159265 2) (+= c Cl))"},
    {"illuminance (\"diffuse\", P, N, 1) c += Cl;", "(illuminance [\"diffuse\"] P (cast:vector N) 1 (+= c Cl))"},
    {"illuminance (P, \"lightcache\", \"refresh\") c += Cl;", "(illuminance P \"lightcache\"=\"refresh\" (+= c Cl))"},
    {"illuminance (P, N, 1, \"light:__nondiffuse\", f) c += Cl;",
     "(illuminance P (cast:vector N) 1 \"light:__nondiffuse\"=>f (+= c Cl))"},
    {"illuminance (P, N, 1, \"send:light:x\", f + 1) c += Cl;",
     "(illuminance P (cast:vector N) 1 \"send:light:x\"=(add:float f 1) (+= c Cl))"},
    {"illuminance (P) { extern vector L; extern color Cl; c += Cl * (L . v1); }",
     "(illuminance P (block (declare) (declare) (+= c (mul:color Cl (cast:color (dot:float L v1))))))"},
    // Keywords of later versions are names.
    {"vector incident = v1;", "(declare (varying vector incident = v1))"},
    {"color light = c; light *= 2;", "(declare (varying color light = c)) (*= light (cast:color 2))"},
    {"float gather = 1; f = gather;", "(declare (varying float gather = 1)) (= f gather)"},
    {"string shader = \"x\";", "(declare (uniform string shader = \"x\"))"},
    {"normal opposite = n;", "(declare (varying normal opposite = n))"},
    {"float surface = 1, volume = 2, constant = 3, public = 4;",
     "(declare (varying float surface = 1) (varying float volume = 2) (varying float constant = 3) (varying float public = 4))"},
};

TEST(FrontStatements, Trees) {
    for (const Case& c : kStatements) EXPECT_EQ(printBody(c.body), c.tree) << c.body;
}

TEST(FrontStatements, DoRunsOnceBeforeTheTest) {
    EXPECT_EQ(printBody("do f += 1; while (f < 3);"), "(block (declare (varying float do = 1)) (while (notequal:bool (?:float "
                                                      "(notequal:bool do 0) 1 (cast:float (less:bool f 3))) 0) "
                                                      "(block (= do 0) (+= f 1))))");
}

std::string shaderOf(const std::string& text) {
    auto c = compileSnippet(text);
    return c.program && !c.program->shaders.empty() ? print(*c.program->shaders[0]) : c.text();
}

TEST(FrontShaders, Parameters) {
    EXPECT_EQ(shaderOf("surface s(float a = 1, b = 2; varying color c = 0;) {}"),
              "surface s(uniform float a = 1; uniform float b = 2; varying color c = (cast:color 0)) (block)");
    EXPECT_EQ(shaderOf("surface s(float a = 1, color c = 1) {}"),
              "surface s(uniform float a = 1; uniform color c = (cast:color 1)) (block)");
    EXPECT_EQ(shaderOf("surface s(output varying color o = 0;) { o = 1; }"),
              "surface s(output varying color o = (cast:color 0)) (block (= o (cast:color 1)))");
    EXPECT_EQ(shaderOf("surface s(float a = 1, b = a * 2) {}"),
              "surface s(uniform float a = 1; uniform float b = (mul:float a 2)) (block)");
    EXPECT_EQ(shaderOf("surface s(uniform float x[] = {1, 2};) {}"),
              "surface s(uniform float[2] x = (list:float[2] 1 2)) (block)");
    EXPECT_EQ(shaderOf("surface s(color c[];) {}"), "surface s(uniform color[] c) (block)");
    EXPECT_EQ(shaderOf("surface s(color d[3] = {0,0};) {}"),
              "surface s(uniform color[3] d = (list:color[3] (cast:color 0) (cast:color 0))) (block)");
    EXPECT_EQ(shaderOf("surface s(point p = point \"shader\" (0,0,0)) {}"),
              "surface s(uniform point p = (point \"shader\" 0 0 0)) (block)");
    EXPECT_EQ(shaderOf("surface s {}"), "surface s() (block)");
}

TEST(FrontShaders, KindsAndLights) {
    EXPECT_EQ(shaderOf("light l(point from = 0) { illuminate(from) { Cl = 1; } }"),
              "light l(uniform point from = (cast:point 0)) (block (illuminate from (block (= Cl (cast:color 1)))))");
    EXPECT_EQ(shaderOf("light l() { solar(vector (0,0,1), 0) Cl = 1; }"),
              "light l() (block (solar (vector 0 0 1) 0 (= Cl (cast:color 1))))");
    EXPECT_EQ(shaderOf("light l() { solar() Cl = 1; }"), "light l() (block (solar (= Cl (cast:color 1))))");
    EXPECT_EQ(shaderOf("light l() { illuminate(P, N, 1) Cl = length(L); }"),
              "light l() (block (illuminate P (cast:vector N) 1 (= Cl (cast:color (length:float L)))))");
    EXPECT_EQ(shaderOf("displacement d() { P += N; N = calculatenormal(P); }"),
              "displacement d() (block (+= P (cast:point N)) (= N (rsl calculatenormal:normal P)))");
    EXPECT_EQ(shaderOf("volume v() { Ci = Ci * 2; }"), "volume v() (block (= Ci (mul:color Ci (cast:color 2))))");
    EXPECT_EQ(shaderOf("imager i() { alpha = 1; }"), "imager i() (block (= alpha 1))");
}

TEST(FrontShaders, GlobalsByKind) {
    EXPECT_EQ(globalVariables(ShaderKind::Surface).size(), 24u); // RISpec 3.2, 12.1
    const auto has = [](ShaderKind k, const std::string& name) {
        for (const auto& g : globalVariables(k))
            if (g.name == name) return true;
        return false;
    };
    EXPECT_TRUE(has(ShaderKind::Light, "Ps"));
    EXPECT_FALSE(has(ShaderKind::Light, "Ci"));
    EXPECT_FALSE(has(ShaderKind::Displacement, "Ci"));
    EXPECT_TRUE(has(ShaderKind::Imager, "alpha"));
    EXPECT_TRUE(has(ShaderKind::Volume, "N")); // of 3Delight
    EXPECT_FALSE(has(ShaderKind::Volume, "dPdu"));
}

TEST(FrontFunctions, OverloadsByArgumentAndResult) {
    const char* text = "float f(float x) { return x; }\ncolor f(float x) { return x; }\nfloat f(color x) { return x[0]; }\n"
                       "surface s() { float a = f(1); color b = f(1); float c = f(Cs); color d = color f(u); }";
    EXPECT_EQ(shaderOf(text),
              "surface s() (block (declare (varying float a = (call f:float 1))) (declare (varying color b = (call f:color 1))) "
              "(declare (varying float c = (call f:float Cs))) (declare (varying color d = (call f:color u))))");
}

TEST(FrontFunctions, Forms) {
    EXPECT_EQ(shaderOf("void g(output float a; float b, c) { a = b + c; } surface s() { float x; g(x, 1, 2); }"),
              "surface s() (block (declare (varying float x)) (call g:void x 1 2))");
    EXPECT_EQ(shaderOf("half(float x) { return x / 2; } surface s() { Ci = half(u); }"),
              "surface s() (block (= Ci (cast:color (call half:float u))))");
    EXPECT_EQ(shaderOf("float sum(float x[]) { return x[0] + x[1]; } surface s() { float y[2] = {1, 2}; Ci = sum(y); }"),
              "surface s() (block (declare (varying float[2] y = (list:float[2] 1 2))) (= Ci (cast:color (call sum:float y))))");
    EXPECT_EQ(shaderOf("surface s() { float k = 2; float twice(float x) { return k * x; } Ci = twice(u); }"),
              "surface s() (block (declare (varying float k = 2)) (declare) (= Ci (cast:color (call twice:float u))))");
    // A function of the user hides the shadeop of its name, but only where it fits.
    EXPECT_EQ(shaderOf("float max(float a; string b) { return a; } surface s() { Ci = max(1, \"x\"); Oi = max(1, u); }"),
              "surface s() (block (= Ci (cast:color (call max:float 1 \"x\"))) (= Oi (cast:color (max:float 1 u))))");
}

TEST(FrontFunctions, GlobalsAreTheShadersOwn) {
    const auto c = compileSnippet("float f() { extern point P; return xcomp(P) + u; }\nsurface s() { P; Ci = f() + u; }");
    ASSERT_TRUE(c.program) << c.text();
    const Function& f = *c.program->functions.at(0);
    const Shader& s = *c.program->shaders[0];
    // return (add (xcomp P) u): the symbols are those of the shader.
    const Expr& sum = *f.body->body.back()->value;
    EXPECT_EQ(sum.args[0]->args[0]->symbol, s.body->body[0]->value->symbol);
    bool owned = false;
    for (const auto& symbol : s.symbols) owned |= symbol.get() == sum.args[1]->symbol;
    EXPECT_TRUE(owned);
}

TEST(FrontFunctions, EachShaderHasItsOwnCopy) {
    const auto c = compileSnippet(
        "color f() { return Cl; }\nsurface a() { illuminance(P) Ci += f(); }\nlight b() { illuminate(P) Cl = f(); }");
    ASSERT_TRUE(c.program) << c.text();
    EXPECT_EQ(c.program->functions.size(), 2u);
}

TEST(FrontFunctions, ExternReachesParameters) {
    EXPECT_EQ(compileSnippet("float f() { extern float Kd; return Kd; } surface s(float Kd = 1) { Ci = f(); }").text(), "");
}

TEST(FrontFunctions, RslShadeopsAreBoundToTheirText) {
    const auto c = compileSnippet("surface s() { normal nn = calculatenormal(P); Ci = area(P) + area(P, \"dicing\"); }");
    ASSERT_TRUE(c.program) << c.text();
    EXPECT_EQ(c.program->functions.size(), 3u);
    const Expr& e = *c.program->shaders[0]->body->body[0]->declarators[0].init;
    EXPECT_EQ(e.kind, ExprKind::FunctionCall);
    ASSERT_TRUE(e.shadeop && e.function);
    EXPECT_EQ(e.shadeop->name, "calculatenormal");
}

TEST(FrontFunctions, EveryRslShadeopCompiles) {
    for (const Shadeop& op : allShadeops()) {
        if (op.lowering != Lowering::Rsl) continue;
        ShaderKind kind = ShaderKind::Surface;
        while (!(op.contexts & contextOf(kind))) kind = ShaderKind(int(kind) + 1);
        for (const Signature& s : op.signatures) {
            std::string declarations, arguments;
            for (size_t i = 0; i < s.parameters.size(); ++i) {
                const std::string name = "x" + std::to_string(i);
                Type t = s.parameters[i].type;
                if (t.array < 0) t.array = 4;
                const bool shader = s.text.find("shader " + s.parameters[i].name) != std::string::npos;
                declarations += (shader ? "shader" : toString(t.element())) + " " + name +
                                (t.array ? "[" + std::to_string(t.array) + "]" : "") + "; ";
                arguments += (i ? ", " : "") + name;
            }
            const std::string cast =
                s.result.base == Base::Void || s.result.array ? "" : toString(s.result) + " y = " + toString(s.result) + " ";
            const auto c = compileSnippet(std::string(toString(kind)) + " t() { " + declarations + cast + op.name + "(" +
                                          arguments + "); }");
            EXPECT_TRUE(c.program) << s.text << "\n" << c.text();
        }
    }
}

} // namespace
} // namespace alpenglow::rsl::front_statements_test

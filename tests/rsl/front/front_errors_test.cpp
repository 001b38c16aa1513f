// What is wrong, where, and what is said about it; and that nothing breaks the front end.
#include "base/limits.h"
#include "front_helpers.h"
#include <chrono>
#include <random>

namespace alpenglow::rsl::front_errors_test {
namespace {

struct Case {
    const char* body;
    const char* message;
};

/// Bodies begin on line 2, column 1. One message each, which begins so.
const Case kBodies[] = {
    {"f = x;", "2:5: error: 'x' is not declared"},
    {"foo(f);", "2:1: error: there is no function 'foo'"},
    {"f = sqr(f);", "2:5: error: there is no function 'sqr' (did you mean 'sqrt'?)"},
    {"color colour = c; c = color1;", "2:23: error: 'color1' is not declared"},
    {"f = strr;", "2:5: error: 'strr' is not declared (did you mean 'str'?)"},
    {"f = c;", "2:3: error: cannot assign color to float (a component is read by"},
    {"f = str;", "2:3: error: cannot assign string to float"},
    {"str = f;", "2:5: error: cannot assign float to string"},
    {"c = p;", "2:3: error: cannot assign point to color"},
    {"c = c + p;", "2:7: error: '+' cannot combine color and point"},
    {"m = m + mm;", "2:7: error: '+' cannot combine matrix and matrix"},
    {"p = m * p;", "2:7: error: '*' cannot combine matrix and point (transform"},
    {"c = c ^ d;", "2:7: error: '^' cannot combine color and color"},
    {"f = f ^ 2;", "2:7: error: '^' cannot combine float and float ('^' is the cross product; pow"},
    {"f = f . g;", "2:7: error: '.' cannot combine float and float"},
    {"str = -str;", "2:7: error: '-' cannot be applied to string"},
    {"if (str) f = 1;", "2:5: error: string cannot be a condition"},
    {"if (str < \"a\") f = 1;", "2:9: error: '<' cannot combine string and string"},
    {"f = sqrt(c);", "2:5: error: 'sqrt' cannot be called with (color) (it can be called as float sqrt(float"},
    {"f = sqrt();", "2:5: error: 'sqrt' cannot be called without arguments"},
    {"f = sqrt(f, g);", "2:5: error: 'sqrt' cannot be called with (float, float)"},
    {"fresnel(v1, n, f, 1, h);", "2:1: error: an output argument of 'fresnel' must be a variable"},
    {"1 = f;", "2:3: error: what stands left of the assignment is not a variable"},
    {"f + g = h;", "2:7: error: what stands left of the assignment is not a variable"},
    {"PI = 3;", "2:4: error: what stands left of the assignment is not a variable"},
    {"a[4] = 1;", "2:3: error: index 4 is outside an array of 4"},
    {"f = c[3];", "2:7: error: a tuple has components 0, 1 and 2"},
    {"f = g[0];", "2:6: error: float has no elements"},
    {"f = m[0];", "2:6: error: matrix has no elements (comp(m"},
    {"f = str[0];", "2:3: error: cannot assign string to float"},
    {"f = a[c];", "2:7: error: an index must be a float, not color"},
    {"f = a;", "2:3: error: cannot assign float[4] to float"},
    {"a = ca;", "2:3: error: cannot assign color[3] to float[4]"},
    {"a = {1,2,3,4,5};", "2:3: error: cannot assign an array of 5 to float[4]"},
    {"float b[2] = {1,2,3};", "2:19: error: 3 elements for an array of 2"},
    {"float b[0];", "2:8: error: the length of an array must be between 1 and"},
    {"float b[0];", "2:8: error: the length of an array must be between 1 and"},
    {"float b[2][2];", "2:11: error: an array of arrays is not allowed"},
    {"float b[3]; push(b, 1);", "2:18: error: the length of 'b' is fixed"},
    {"f = float c;", "2:5: error: cannot convert color to float"},
    {"f = float \"x\" g;", "2:11: error: a float is in no space"},
    {"c = (1, 2);", "2:5: error: 2 values in parentheses: a tuple has 3"},
    {"c = color (str, 1, 2);", "2:12: error: a component must be a float, not string"},
    {"break;", "2:1: error: 'break' outside a loop"},
    {"while (f < 1) { continue 2; }", "2:17: error: 'continue 2' inside 1 loop"},
    {"return 1;", "2:1: error: a shader returns no value"},
    {"illuminate(P) Cl = 1;", "2:1: error: 'illuminate' cannot be used in a surface shader"},
    {"illuminance(P, N) c += Cl;", "2:1: error: wrong arguments of 'illuminance' (illuminance([category,]"},
    {"illuminance(P, N, 1, \"light:x\", 3) ;", "2:33: error: the value of \"light:x\" must be a variable"},
    {"time = 1;", "2:1: error: 'time' cannot be written"},
    {"float x = 1; color x = 2;", "2:20: error: 'x' was declared in this block already, as float"},
    {"extern float nothing;", "2:14: error: there is no 'nothing' outside"},
    {"extern color P;", "2:14: error: 'P' is point outside, not color"},
    {"f = 1.2.3;", "2:8: error: expected ';' after an expression before '.3'"},
    {"f = 12abc;", "2:5: error: '12abc' is not a number"},
    {"f = 0x10;", "2:5: error: '0x10' is not a number"},
    {"f = g g;", "2:7: error: expected ';' after an expression before 'g'"},
    {"f = (g;", "2:7: error: expected ')' before ';'"},
    {"f = g +;", "2:8: error: expected an expression before ';'"},
    {"f = sqrt(f;", "2:11: error: expected ',' or ')' after an argument before ';'"},
    {"if f > 1 g = 2;", "2:4: error: expected"},
    {"else f = 1;", "2:1: error: 'else' without 'if'"},
    {"vectr x = 0;", "2:1: error: 'vectr' is not a type (did you mean 'vector'?)"},
    {"f = @;", "2:5: error: the character '@' means nothing here"},
    {"str = \"abc;", "2:7: error: this string does not end on its line"},
    {"f = texture(\"a\", \"blur\", c);", "2:26: error: expected a float, not color"},
    {"f->g(1);", "2:2: error: '->' needs a structure or a shader, not float"},
    {"void v;", "2:1: error: a variable cannot be void"},
};

const Case kWarnings[] = {
    {"int i = 0; f = i;", "2:1: warning: there is no type 'int'; float is taken, numbers are not rounded"},
    {"f = (float) g;", "2:5: warning: a conversion is written without parentheses around the type (write float(...)"},
    {"f++;", "2:2: warning: '++' is not of this language; it is read as '+= 1'"},
    {"--f;", "2:1: warning: '--' is not of this language; it is read as '-= 1'"},
    {"f = g % 2;", "2:7: warning: '%' is not of this language; it is read as mod(a, b)"},
    {"f = 1, g = 2;", "2:6: warning: statements are separated by ';', not ','"},
    {"f = xcomp(Ns);", "2:11: warning: 'Ns' belongs to light shaders; 'N' is used"},
    {"uniform float k = u;", "2:19: warning: a varying value is given to the uniform variable 'k'"},
    {"uniform float k; k = f;", "2:22: warning: a varying value is given to the uniform variable 'k'"},
    {"I = normalize(I);", "2:1: warning: 'I' is read-only in a surface shader; the shader changes a copy of its own"},
    {"u = 1;", "2:1: warning: 'u' is read-only in a surface shader"},
    {"f + 1;", "2:3: warning: this expression has no effect"},
    {"f = 1.0f;", "2:5: warning: numbers take no suffix"},
    {"c = texture(\"a\", \"blurr\", 1);",
     "2:18: warning: 'texture' has no parameter \"blurr\"; it is ignored (did you mean \"blur\"?)"},
    {"f = pow(f; 2);", "2:10: warning: arguments are separated by ',', not ';'"},
};

/// The whole text of the file.
const Case kFiles[] = {
    {"", "1:1: error: there is no shader in this file"},
    {"surfac s() {}", "1:1: error: expected a shader or a function before 'surfac' (did you mean 'surface'?)"},
    {"surface s( {}", "1:12: error: expected ')' after the parameters"},
    {"surface s(float a = ) {}", "1:21: error: expected an expression before ')'"},
    {"surface s(flot a = 1) {}", "1:11: error: expected the type of a parameter before 'flot'"},
    {"surface s() { Ci = 1;", "1:22: error: expected '}' before the end of the file (the block began at line 1)"},
    {"surface s(float a = 1, a = 2) {}", "1:24: error: there are two parameters called 'a'"},
    {"surface s(float a = \"x\") {}", "1:21: error: expected a float, not string"},
    {"light l() { Cl = diffuse(N); }", "1:18: error: 'diffuse' cannot be used in a light shader"},
    {"light l() { Ci = 1; }", "1:13: error: 'Ci' is not declared in a light shader"},
    {"displacement d() { illuminance(P) ; }", "1:20: error: 'illuminance' cannot be used in a displacement shader"},
    {"float f(float x) { return f(x - 1); }\nsurface s() { Ci = f(1); }",
     "1:27: error: function 'f' calls itself; recursion is not allowed"},
    {"float g(float x) { return h(x); }\nfloat h(float x) { return g(x); }\nsurface s() { Ci = g(1); }",
     "2:27: error: function 'g' calls itself"},
    {"surface s() { float f(float x) { return f(x); } Ci = f(1); }", "1:41: error: function 'f' calls itself"},
    {"float f(float x) { return; } surface s() { Ci = f(1); }", "1:20: error: function 'f' must return a float"},
    {"void f(float x) { return x; } surface s() { f(1); }", "1:26: error: function 'f' is void and returns no value"},
    {"float f(float x) { x + 1; } surface s() {}", "1:7: warning: function 'f' can end without returning a value"},
    {"float f(float x) { return Kd; } surface s(float Kd = 1) { Ci = f(1); }",
     "1:27: warning: 'Kd' is a parameter of the shader, used without being declared extern (declare 'extern float Kd;')"},
    {"void f(float x) { x = 1; } surface s() { f(1); }",
     "1:19: warning: parameter 'x' is not output; the function changes a copy"},
    {"surface s(float a = 1) { a = 2; }", "1:26: warning: parameter 'a' is not output; the shader changes a copy"},
    {"surface s(float a;) { }", "1:17: warning: parameter 'a' has no default value; it is zero unless set"},
    {"surface s(float a = 1 color b = 1) { }", "1:22: warning: expected ';' before the next parameter"},
    {"struct X { float a; }\nsurface s() { X x; x = 1; }", "2:24: error: expected a value of structure 'X'"},
    {"struct X { float a; }\nsurface s() { X float l->a = 1; }", "2:23: error: 'l' is not declared"},
    {"class c(float a = 1;) { public void surface(output color Ci, Oi) { Ci = a; x = 1; } }", "1:76: error: 'x' is not declared"},
    {"#include \"nowhere.h\"\nsurface s() { Ci = helper(name); }", "1:10: error: cannot find the included file 'nowhere.h'"},
    {"#if 1\nsurface s() {}", "1:1: warning: this #if has no #endif"},
    {"surface s() {}\n#if 0\nfloat f(", "2:1: warning: this #if has no #endif (the rest of its file is skipped"},
    {"#endif\nsurface s() {}", "1:1: error: #endif without #if"},
    {"#error no\nsurface s() {}", "1:1: error: #error no"},
    {"#nonsense\nsurface s() {}", "1:2: warning: unknown directive '#nonsense'"},
    {"#define M(x) x\nsurface s() { Ci = M(1, 2); }", "2:20: error: macro 'M' takes 1 arguments, not 2"},
    {"surface s() {} /* never", "1:16: error: this comment does not end"},
    {"#line 100 \"orig.sl\"\nsurface s() { Ci = x; }", "100:20: error: 'x' is not declared"},
    {"#define BAD nothing\nsurface s() { Ci = 2 *\n   BAD; }", "3:4: error: 'nothing' is not declared"},
    {"surface s() { Ci = 1\n  Oi = 1; }", "1:21: error: expected ';' after an expression"},
    {"surface s() { Ci = undefined1; }\nfloat f() { return undefined2; }",
     "1:20: error: 'undefined1' is not declared\n2:20: warning: 'undefined2' is not declared"},
};

TEST(FrontErrors, Bodies) {
    for (const Case& c : kBodies)
        EXPECT_EQ(compileBody(c.body).text().substr(0, std::string(c.message).size()), c.message) << c.body;
}

TEST(FrontErrors, Warnings) {
    for (const Case& c : kWarnings) {
        const auto r = compileBody(c.body);
        EXPECT_EQ(r.text().substr(0, std::string(c.message).size()), c.message) << c.body;
        EXPECT_TRUE(r.program) << c.body;
        EXPECT_EQ(r.messages.size(), 1u) << c.body << "\n" << r.text();
    }
}

TEST(FrontErrors, Files) {
    for (const Case& c : kFiles)
        EXPECT_EQ(compileSnippet(c.body).text().substr(0, std::string(c.message).size()), c.message) << c.body;
}

TEST(FrontErrors, OneFaultOneMessage) {
    for (const Case& c : kBodies) {
        const auto r = compileBody(c.body);
        EXPECT_EQ(r.errors(), 1) << c.body << "\n" << r.text();
        EXPECT_FALSE(r.program);
    }
    for (const Case& c : kFiles) {
        const auto r = compileSnippet(c.body);
        EXPECT_LE(r.errors(), 2) << c.body << "\n" << r.text();
    }
}

TEST(FrontErrors, AllInOneGo) {
    const auto r = compileBody("f = x;\nc = p;\nf = g +;\nsqrt(c);\n");
    EXPECT_EQ(r.errors(), 4) << r.text();
    // What stands in a statement that could not be read may have been declared there; nothing else is excused.
    const auto hidden = compileBody("float k zz = 3;\nf = zz;\nf = yy;\n");
    EXPECT_EQ(hidden.errors(), 2) << hidden.text();
    const auto all = compileBody("f = x;\nc = p;\nsqrt(c);\nf = y;\n");
    EXPECT_EQ(all.errors(), 4) << all.text();
}

TEST(FrontErrors, UnknownNameIsToldOnce) { EXPECT_EQ(compileBody("f = x; g = x + x; x = 2;").errors(), 1); }

TEST(FrontErrors, LineAndCaret) {
    const auto r = compileSnippet("surface s()\n{\n\tCi = Kqqq;\n}\n", {}, "folder/s.sl");
    ASSERT_EQ(r.messages.size(), 1u);
    EXPECT_EQ(toString(r.messages[0]),
              "folder/s.sl:3:7: error: 'Kqqq' is not declared [undeclared]\n  \tCi = Kqqq;\n  \t     ^~~~\n");
}

TEST(FrontErrors, WhatALineRepeatsIsCounted) {
    std::string body;
    for (int i = 0; i < 100; ++i) body += "f++; ";
    const Compiled c = compileBody(body + "\nf++;");
    const std::string text = c.text(), what = "'++' is not of this language";
    size_t count = 0;
    for (size_t at = 0; (at = text.find(what, at)) != text.npos; ++at) ++count;
    EXPECT_EQ(count, 21u) << text; // twenty of the first line, one of the second
    ASSERT_EQ(c.messages.size(), 21u);
    EXPECT_EQ(c.messages[19].notes, std::vector<std::string>{"there are 80 more of these in this line"});
}

TEST(FrontErrors, MissingFile) {
    Diagnostics d;
    EXPECT_FALSE(compileFile("no/such/file.sl", {}, d));
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(d.all()[0].code, Rie::NoFile);
}

TEST(FrontErrors, ErrorsAreBounded) {
    std::string body;
    for (int i = 0; i < 1000; ++i) body += "f = unknown" + std::to_string(i) + ";\n";
    EXPECT_LE(compileBody(body).errors(), limits::kFrontErrors + 1);
}

// ---- hostile input

std::string repeat(const std::string& s, int n) {
    std::string r;
    for (int i = 0; i < n; ++i) r += s;
    return r;
}

TEST(FrontHostile, DepthIsBounded) {
    const int n = 100'000;
    for (const std::string& body :
         {"f = " + repeat("(", n) + "1" + repeat(")", n) + ";", "f = " + repeat("-", n) + "1;", "f = " + repeat("!", n) + "1;",
          repeat("{", n), repeat("if (f) ", n) + ";", repeat("while (f) ", n) + ";", "f = " + repeat("sqrt(", n) + ";",
          "f = " + repeat("1 + ", n) + "1;", "f = " + repeat("f ? 1 : ", n) + "1;", "f = " + repeat("f = ", n) + "1;",
          "f = " + repeat("float ", n) + "1;", "f = a" + repeat("[a", n) + ";", "f = " + repeat("{", n) + ";",
          repeat("float f(float x) { ", n), "if (f) ; " + repeat("else if (f) ; ", n), repeat("do ", n) + ";"}) {
        const auto r = compileBody(body);
        EXPECT_FALSE(r.program) << body.substr(0, 40);
        EXPECT_GE(r.errors(), 1);
    }
}

TEST(FrontHostile, LongSumsBelowTheLimitAreFine) {
    EXPECT_TRUE(compileBody("f = " + repeat("1 + ", limits::kTreeHeight / 2) + "1;").program);
    EXPECT_TRUE(
        compileBody("f = " + repeat("(", limits::kExpressionDepth / 4) + "1" + repeat(")", limits::kExpressionDepth / 4) + ";")
            .program);
}

TEST(FrontHostile, MacrosAreBounded) {
    std::string text = "#define A0 1 + 1\n";
    for (int i = 1; i < 40; ++i)
        text += "#define A" + std::to_string(i) + " A" + std::to_string(i - 1) + " + A" + std::to_string(i - 1) + "\n";
    EXPECT_FALSE(compileSnippet(text + "surface s() { Ci = A39; }").program);
    EXPECT_FALSE(
        compileSnippet("#define F(x) x\nsurface s() { Ci = " + repeat("F(", 10'000) + "1" + repeat(")", 10'000) + "; }").program);
    EXPECT_TRUE(
        compileSnippet("#define X X + 1\n#define Y Z\n#define Z Y\nsurface s() { float X1 = 1, Y = 2, X = 3; }").messages.size() <
        9);
}

TEST(FrontHostile, ArraysAreBounded) { EXPECT_FALSE(compileBody("float b[1000000000] = 0;").program); }

const char* kSample =
    "#define SQ(x) ((x)*(x))\n/* c */ float f(float x; output color c) { extern point P; c = noise(P); return SQ(x); }\n"
    "surface s(float Kd = .5, a[3] = {1,2,3}; string map = \"a\\\"b\"; color hsv = color \"hsv\" (1,0,1);) {\n"
    "  normal Nf = faceforward(normalize(N), I); color c = 0; float i;\n"
    "  for (i = 0; i < 3; i += 1) { if (a[i] > 2 && !(i == 1)) break; else c += f(a[i], c) * (N ^ I) . I; }\n"
    "  illuminance(\"x\", P, Nf, PI/2, \"light:y\", i) { c += Cl * normalize(L) . Nf; }\n"
    "  Ci = map != \"\" ? Kd * color texture(map[0], s, t, \"blur\", .1) : diffuse(Nf); Oi = Os;\n}\n";

TEST(FrontHostile, EveryPrefix) {
    const std::string text = kSample;
    EXPECT_TRUE(compileSnippet(text).program) << compileSnippet(text).text();
    for (size_t i = 0; i < text.size(); ++i) {
        const auto r = compileSnippet(text.substr(0, i));
        EXPECT_TRUE(r.program || r.errors() > 0) << i;
    }
}

TEST(FrontHostile, TokenSoup) {
    const std::vector<std::string> words = {
        "surface",     "s",          "(",      ")",       "{",     "}",       "[",      "]",
        ";",           ",",          "float",  "color",   "point", "string",  "f",      "P",
        "Ci",          "1",          "2.5",    "\"x\"",   "=",     "+=",      "+",      "-",
        "*",           "/",          "^",      ".",       "<",     "==",      "&&",     "!",
        "?",           ":",          "if",     "else",    "while", "for",     "break",  "return",
        "illuminance", "extern",     "output", "uniform", "noise", "texture", "->",     "#define M(a) a\n",
        "\n#if 1\n",   "\n#endif\n", "M(",     "matrix",  "void",  "light",   "gather", "struct",
        "do",          "\n"};
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        std::string text = i % 2 ? "surface s() {\n" : "";
        for (int k = 0; k < 60; ++k) text += words[random() % words.size()] + " ";
        const auto r = compileSnippet(text);
        EXPECT_TRUE(r.program || r.errors() > 0) << text;
    }
}

TEST(FrontHostile, MutatedBytes) {
    std::mt19937 random(11);
    for (int i = 0; i < 1500; ++i) {
        std::string text = kSample;
        for (int k = 0; k < 4; ++k) text[random() % text.size()] = char(random() % 256);
        const auto r = compileSnippet(text);
        EXPECT_TRUE(r.program || r.errors() > 0) << text;
    }
}

} // namespace
} // namespace alpenglow::rsl::front_errors_test

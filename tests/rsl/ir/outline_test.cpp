// Which functions stay functions.
#include "compile.h"
#include "rsl/passes/outline.h"

namespace alpenglow::rsl::outline_test {
namespace {

const char* const kTwice = "float f(float x) { float i, y = x; for (i = 0; i < x; i += 1) y += sin(i * x); return y; }\n"
                           "surface s() { Ci = f(u) + f(v); }";

KernelOptions outlineAll() {
    KernelOptions o;
    o.outline = 0;
    return o;
}

TEST(Outline, SmallFunctionsAreInlined) {
    const Compiled c = compile(kTwice);
    EXPECT_EQ(c.count(ir::Op::Function), 0);
    EXPECT_EQ(c.count(ir::Op::Call), 0);
    EXPECT_EQ(c.count(ir::Op::Loop), 2);
}

TEST(Outline, LargeOnesStandOnce) {
    const Compiled c = compile(kTwice, outlineAll());
    EXPECT_EQ(c.count(ir::Op::Function), 1);
    EXPECT_EQ(c.count(ir::Op::Call), 2);
    EXPECT_EQ(c.count(ir::Op::Loop), 1);
}

TEST(Outline, EqualCallsAreOne) {
    const Compiled c = compile("float f(float x) { return sin(x) * x; }\nsurface s() { Ci = f(u) + f(u); }", outlineAll());
    EXPECT_EQ(c.count(ir::Op::Call), 1);
}

TEST(Outline, AVariantForEachSetOfDerivatives) {
    const Compiled c = compile("float f(float x) { return sin(x) * x; }\n"
                               "surface s() { Ci = f(u) + Du(f(v)) + Du(f(u * v)) + Du(Dv(f(s))); }",
                               outlineAll());
    EXPECT_EQ(c.count(ir::Op::Function), 3); // no order, first, second
    EXPECT_EQ(c.count(ir::Op::Call), 4);
    for (const ir::Input& i : c.kernel->inputs) {
        if (i.name == "s") EXPECT_EQ(int(i.order), 2);
        if (i.name == "u" || i.name == "v") EXPECT_EQ(int(i.order), 1) << i.name;
    }
}

TEST(Outline, ServicesRaysAndLightsAreInlined) {
    const Compiled c = compile("float f(float x) { printf(\"%f\", x); return x; }\n"
                               "color g(normal n) { color c = 0; illuminance(P, n, 1) c += Cl; return c; }\n"
                               "surface s() { Ci = f(u) + f(v) + g(N) + g(-N) + trace(P, N) + trace(P, -N); }",
                               outlineAll());
    EXPECT_EQ(c.count(ir::Op::Function), 0);
    EXPECT_EQ(c.count(ir::Op::LightLoop), 2);
}

TEST(Outline, WhatRaysGoThroughIsSeenThrough) {
    const Compiled c = compile("color blend(color a, b; float x) { float i, y = 0; for (i = 0; i < x; i += 1) y += sin(i);\n"
                               "    return a * (1 - y) + b * y; }\n"
                               "surface s() { Ci = blend(trace(P, N), trace(P, -N), u) + blend(Cs, Os, v) + blend(Os, Cs, u); }",
                               outlineAll());
    EXPECT_TRUE(c.kernel->facts.affine) << c.kernel->facts.whyNot;
    EXPECT_EQ(c.sites(ir::Op::Emit, "trace"), 2);
    EXPECT_EQ(c.count(ir::Op::Call), 2);
}

std::string doubling(int depth) {
    std::string s = "float f0(float x) { return x + sin(x); }\n";
    for (int n = 1; n <= depth; ++n) {
        const std::string callee = "f" + std::to_string(n - 1);
        s += "float f" + std::to_string(n) + "(float x) { return " + callee + "(x * 2) - " + callee + "(x * 3); }\n";
    }
    return s + "surface s() { Ci = f" + std::to_string(depth) + "(u); }";
}

// f40 holds 2^40 calls of f0.
TEST(Outline, ExponentialInliningStaysSmall) {
    const Compiled c = compile(doubling(40));
    EXPECT_GE(c.count(ir::Op::Function), 4);
    EXPECT_LT(ir::instructionCount(c.kernel->body), 5000u);
}

} // namespace
} // namespace alpenglow::rsl::outline_test

#include "compile.h"
#include <filesystem>
#include <fstream>
#include <sstream>

namespace build_test {

using namespace alpenglow;
using namespace alpenglow::rsl;
using namespace alpenglow::rsl::ir;

namespace {

TEST(Build, EveryShippedShader) {
    for (const auto& file : std::filesystem::directory_iterator(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders")) {
        if (file.path().extension() != ".sl") continue;
        SCOPED_TRACE(file.path().string());
        std::ifstream f(file.path());
        std::stringstream s;
        s << f.rdbuf();
        for (const int form : {0, 1, 2}) {
            KernelOptions o;
            o.path = form == 1;
            o.differences = form == 2;
            const Compiled c = compile(s.str(), o);
            if (c.kernel) EXPECT_FALSE(c.kernel->outputs.empty());
        }
        Diagnostics d;
        const auto p = compileText(s.str(), "x.sl", {}, d);
        ASSERT_NE(p, nullptr);
        const auto defaults = buildDefaults(*p, *p->shaders.back(), d);
        ASSERT_NE(defaults, nullptr);
        EXPECT_EQ(verify(*defaults), "");
        EXPECT_GE(defaults->outputs.size(), p->shaders.back()->parameters.size());
    }
}

TEST(Build, ConstantLoopsAndArraysDisappear) {
    const Compiled c = compile("surface s() { float a[4]; float i; for (i = 0; i < 4; i += 1) a[i] = i * s; float sum = 0;"
                               " for (i = 0; i < 4; i += 1) sum += a[i]; Ci = sum; }");
    EXPECT_EQ(c.count(Op::Loop), 0) << c.text();
    EXPECT_EQ(c.count(Op::ArrayNew), 0) << c.text();
    EXPECT_EQ(c.count(Op::ArrayStore), 0);
}

TEST(Build, ConstantsFold) {
    const Compiled c = compile("surface s() { float x = sqrt(16) * 2 - 3; Ci = x; }");
    EXPECT_EQ(c.count(Op::Runtime), 0) << c.text();
    const Inst* out = nullptr;
    forEach(static_cast<const Region&>(c.kernel->body), [&](const Inst* i) {
        if (i->op == Op::Output && i->index == 0) out = i->args[0];
    });
    ASSERT_NE(out, nullptr);
    ASSERT_EQ(out->op, Op::Const);
    EXPECT_EQ(out->numbers, (std::vector<float>{5, 5, 5}));
}

TEST(Build, StringParametersSpecialise) {
    KernelOptions o;
    o.stringParameters = {{"mode", "red"}};
    const Compiled c =
        compile("surface s(string mode = \"green\") { if (mode == \"red\") Ci = color(1,0,0); else Ci = trace(P, N); }", o);
    EXPECT_EQ(c.count(Op::If), 0);
    EXPECT_EQ(c.count(Op::Emit) + c.count(Op::Request), 0) << c.text();
}

TEST(Build, SmallIfsBecomeSelects) {
    const Compiled c = compile("surface s() { float x = 0; if (s > t) x = s * 2; else x = t; Ci = x; }");
    EXPECT_EQ(c.count(Op::If), 0) << c.text();
    EXPECT_EQ(c.count(Op::Select), 1) << c.text();
}

TEST(Build, SpacesBecomeMatrices) {
    const Compiled c = compile("surface s() { point q = transform(\"shader\", P); Ci = color(q[0], q[1], q[2]); }");
    ASSERT_EQ(c.kernel->inputs.size(), 3u) << c.text(); // P, Os (for Oi), the matrix
    EXPECT_NE(c.text().find("space:current>shader"), std::string::npos);
    const Compiled two = compile("displacement d() { P = transform(\"object\", \"world\", P); }");
    EXPECT_NE(two.text().find("space:object>current"), std::string::npos);
    EXPECT_NE(two.text().find("space:current>world"), std::string::npos);
}

TEST(Build, Lights) {
    const Compiled spot = compile("light l(point from = point \"shader\" (0,0,0); vector axis = vector \"shader\" (0,0,1)) { "
                                  "illuminate(from, axis, PI/4) Cl = 1 / (L . L); }");
    ASSERT_EQ(spot.kernel->outputs.size(), 4u);
    EXPECT_EQ(spot.kernel->outputs[3].name, "lit");
    EXPECT_EQ(spot.kernel->facts.blocks, std::vector<std::string>{"illuminate"});
    const Compiled ambient = compile("light l() { Cl = 0.5; }");
    EXPECT_TRUE(ambient.kernel->facts.ambientLight);
    EXPECT_EQ(ambient.kernel->outputs.size(), 2u);
    const Compiled two = compile("light l() { solar(vector(0,0,1), 0) Cl = 1; illuminate(P) Cl = 2; }");
    EXPECT_EQ(two.kernel->outputs.size(), 8u);
    EXPECT_EQ(two.kernel->outputs[4].name, "L#1");
}

int orderOf(const Compiled& c, const std::string& input) {
    for (const Input& i : c.kernel->inputs)
        if (i.name == input) return i.order;
    return -1;
}

TEST(Build, DerivativeOrders) {
    EXPECT_EQ(orderOf(compile("surface s() { Ci = Du(s * s); }"), "s"), 1);
    EXPECT_EQ(orderOf(compile("surface s() { Ci = Du(s) + t; }"), "t"), 0);
    const Compiled bump =
        compile("displacement d() { P += N * sin(s); N = calculatenormal(P); float x = Du(length(N)); P += x; }");
    EXPECT_EQ(orderOf(bump, "s"), 2) << bump.text();
    const Compiled loop = compile("surface s() { float x = 0; float i; for (i = 0; i < t; i += 1) x += s * i; Ci = Dv(x); }");
    EXPECT_EQ(orderOf(loop, "s"), 1) << loop.text();
    EXPECT_EQ(orderOf(loop, "t"), 0) << loop.text();
    const Compiled third = compile("surface s() { Ci = Du(Du(Du(s))); }");
    EXPECT_NE(third.messages.find("third order"), std::string::npos) << third.messages;
    const Compiled ray = compile("surface s() { Ci = Du(trace(P, N)); }");
    EXPECT_NE(ray.messages.find("trace()"), std::string::npos) << ray.messages;
}

int zeroDivisions(const Compiled& c) {
    int n = 0;
    for (size_t at = 0; (at = c.messages.find("division by 0", at)) != std::string::npos; ++at) ++n;
    return n;
}

TEST(Build, DivisionByAConstantZeroIsToldAtItsPlace) {
    const Compiled plain = compile("surface s() {\n  float w = 2 - 2;\n  Ci = Cs / w;\n}");
    EXPECT_EQ(zeroDivisions(plain), 1) << plain.messages;
    EXPECT_NE(plain.messages.find("test.sl:3:11: warning"), std::string::npos) << plain.messages;
    const Compiled constant = compile("surface s() { float w = 2; Ci = w / (w - 2); }");
    EXPECT_EQ(zeroDivisions(constant), 1) << constant.messages;
    EXPECT_EQ(constant.count(Op::Div), 0) << constant.text(); // folded all the same
    const Compiled assigned = compile("float half(float x; float y) { float r = x; r /= y; return r; }\n"
                                      "surface s() { Ci = half(s, 0); Oi = half(t, 2); }");
    EXPECT_EQ(zeroDivisions(assigned), 1) << assigned.messages;
    EXPECT_NE(assigned.messages.find("test.sl:1:47: warning"), std::string::npos) << assigned.messages;
    const Compiled turn = compile("surface s() { float i, x = 0; for (i = 0; i < 3; i += 1) x += s / i; Ci = x; }");
    EXPECT_EQ(zeroDivisions(turn), 1) << turn.messages;
    const Compiled component = compile("surface s() { Ci = Cs / color(1, 0, 1); }");
    EXPECT_NE(component.messages.find("component of 0"), std::string::npos) << component.messages;
}

TEST(Build, DivisionByZeroThatIsNeverReachedIsNotTold) {
    for (const char* body : {"float w = 0; Ci = w == 0 ? Cs : Cs / w;",                     // the other side is taken
                             "float w = 0; float x = s / w; Ci = Cs;",                      // nobody reads it
                             "float w = 0; if (w > 0 && s > 0.5) Ci = Cs / w;",             // never
                             "float i; for (i = 0; i < 3; i += 1) if (i > 0) Ci += s / i;", // not in that turn
                             "Ci = smoothstep(0.5, 0.5, s);",                               // ours
                             "Ci = Cs / t;"})
        EXPECT_EQ(compile(std::string("surface s() { ") + body + " }").messages, "") << body;
    KernelOptions plain; // without folding it is not known what is reached
    plain.optimize = 0;
    EXPECT_EQ(compile("surface s() { float w = 0; if (w > 0) Ci = Cs / w; }", plain).messages, "");
}

TEST(Build, UnboundedInliningIsAnError) {
    std::string s = "float f0(float x) { return random() + x; }\n";
    for (int n = 1; n < 24; ++n)
        s += "float f" + std::to_string(n) + "(float x) { return f" + std::to_string(n - 1) + "(x) + f" + std::to_string(n - 1) +
             "(x + 1); }\n";
    s += "surface s() { Ci = f23(s); }";
    Diagnostics d;
    const auto p = compileText(s, "x.sl", {}, d);
    ASSERT_NE(p, nullptr);
    EXPECT_EQ(buildKernel(*p, *p->shaders.back(), {}, d), nullptr);
    EXPECT_EQ(d.errors(), 1);
}

} // namespace

} // namespace build_test

// The walk over syntax trees, and what expressions write.
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <gtest/gtest.h>
#include <map>

namespace alpenglow::rsl {
namespace {

std::unique_ptr<Program> checked(const std::string& text) {
    Diagnostics d;
    auto p = compileText(text, "test.sl", {}, d);
    EXPECT_TRUE(p) << (d.all().empty() ? "" : toString(d.all()[0]));
    return p;
}

TEST(Walk, MeetsEveryExpressionInTheOrderOfTheText) {
    // The numbers count up, but for the step of `for`, which stands before its body, and a channel, which is kept behind the
    // arguments.
    const auto p = checked(R"(surface s(float k = 1)
{
    float a = 2, b[31] = {3, 4};
    for (a = 5; a < 6; a += 9) { a = 10; }
    if (a == 11) a = b[12]; else a = 13;
    while (a > 14) a -= 15;
    color c = color "hsv" (16, 17, 18);
    c = texture("map"[19], 20, 21, "blur", 22);
    illuminance ("-lamp", P, N, 23) { Ci += Cl * 24; }
    gather ("illuminance", P, N, 25, 26, "bias", 27) { a = 28; } else { a = 29; }
    b[30] = a > 31 ? 32 : 33;
    return;
})");
    ASSERT_TRUE(p);
    std::vector<int> numbers;
    front::everyBody(*p, [&](const Stmt& body) {
        front::everyExpr(body, [&](const Expr& e) {
            if (e.kind == ExprKind::Number) numbers.push_back(int(e.number));
        });
    });
    const std::vector<int> text = {2,  3,  4,  5,  6,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18,
                                   20, 21, 19, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33};
    EXPECT_EQ(numbers, text);
}

TEST(Walk, EntersFunctionsInsideOfFunctionsOnce) {
    const auto p = checked("float outer(float x) { float inner(float y) { return y + 1; } return inner(x) + 2; }\n"
                           "surface s() { float mine(float z) { return z + 4; } Ci = mine(outer(u)) + 8; }");
    ASSERT_TRUE(p);
    int sum = 0;
    front::everyBody(*p, [&](const Stmt& body) {
        front::everyExpr(body, [&](const Expr& e) { sum += e.kind == ExprKind::Number ? int(e.number) : 0; });
    });
    EXPECT_EQ(sum, 1 + 2 + 4 + 8);
}

/// Names of the variables that statements of a shader write, with how often.
std::map<std::string, int> written(const std::string& statements) {
    const auto p = checked("float filled(output float a; float b; output color c) { a = b; c = b; return a; }\n"
                           "surface s() { float x = 0, y = 0, z[3] = {0, 0, 0}; color k = 0; " +
                           statements + " }");
    std::map<std::string, int> names;
    if (!p) return names;
    const auto place = [&](const Expr& e) {
        if (const Symbol* s = front::rootOf(e)) ++names[s->name];
    };
    front::everyStmt(
        *p->shaders.back()->body, [&](const Stmt& s) { front::eachWritten(s, place); },
        [&](const Expr& e) { front::eachWritten(e, place); });
    return names;
}

using Names = std::map<std::string, int>;

TEST(Writes, AssignmentsAndElements) {
    EXPECT_EQ(written("x = y; z[1] = x; x += 1;"), (Names{{"x", 2}, {"z", 1}}));
    EXPECT_EQ(written("k[0] = x;"), (Names{{"k", 1}}));
    EXPECT_EQ(written("printf(\"%f\", x == y ? 1 : 2);"), Names{});
}

TEST(Writes, OutputsOfFunctionsShadeopsAndTokens) {
    EXPECT_EQ(written("filled(x, y, k);"), (Names{{"k", 1}, {"x", 1}}));
    EXPECT_EQ(written("x = filled(z[2], y, k);"), (Names{{"k", 1}, {"x", 1}, {"z", 1}}));
    EXPECT_EQ(written("surface(\"Kd\", x);"), (Names{{"x", 1}}));      // RISpec 3.2, 15.8
    EXPECT_EQ(written("vector r, t; fresnel(I, N, 1.5, x, y, r, t);"), // RISpec 3.2, 15.3
              (Names{{"r", 1}, {"t", 1}, {"x", 1}, {"y", 1}}));
    EXPECT_EQ(written("k = trace(P, N, \"bias\", y);"), (Names{{"k", 1}}));
    EXPECT_EQ(written("gather(\"illuminance\", P, N, 0, 1, \"surface:Ci\", k, \"bias\", y) x = 1;"), (Names{{"k", 1}, {"x", 1}}));
    EXPECT_EQ(written("illuminance(P, N, 1, \"light:gain\", x, \"send:light:y\", y) {}"), (Names{{"x", 1}}));
}

TEST(Writes, AMethodOfAnotherShaderMayWriteWhatItIsGiven) {
    const auto p = checked("surface s() { shader h = getshader(\"h\"); float x = 0; h->fill(x, 2); }");
    ASSERT_TRUE(p);
    int perhaps = 0;
    front::everyExpr(*p->shaders.back()->body, [&](const Expr& e) {
        if (e.kind != ExprKind::Method) return;
        EXPECT_EQ(front::writesArgument(e, 0), front::Writes::No); // the handle
        for (size_t i = 1; i < e.args.size(); ++i) perhaps += front::writesArgument(e, i) == front::Writes::Perhaps;
    });
    EXPECT_EQ(perhaps, 2);
}

TEST(Writes, TextsOfShadeopsHaveTheOutputsOfTheirSignatures) {
    int outputs = 0;
    for (const Shadeop& op : allShadeops()) {
        if (op.lowering != Lowering::Rsl) continue;
        Diagnostics d;
        const auto p = compileText(op.rsl + "\nsurface __s() {}", "text.sl", {}, d);
        if (!p) continue; // it calls what only the renderer's own texts may
        for (const Signature& s : op.signatures)
            for (const auto& f : p->functions) {
                bool same = f->name == op.name && f->result == s.result && f->parameters.size() >= s.parameters.size();
                for (size_t i = 0; same && i < s.parameters.size(); ++i) same = f->parameters[i]->type == s.parameters[i].type;
                for (size_t i = 0; same && i < s.parameters.size(); ++i, ++outputs)
                    EXPECT_EQ(f->parameters[i]->output, s.parameters[i].output) << s.text << ", parameter " << i;
            }
    }
    EXPECT_GT(outputs, 0);
}

} // namespace
} // namespace alpenglow::rsl

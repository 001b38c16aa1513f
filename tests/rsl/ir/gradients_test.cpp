// Slopes of textures are asked for where derivatives are wanted, and nowhere else.
#include "compile.h"

namespace gradients_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

int chains(const Compiled& c) {
    int n = 0;
    ir::forEach(static_cast<const ir::Region&>(c.kernel->body),
                [&](const ir::Inst* i) { n += i->op == ir::Op::Runtime && i->text.rfind("al_chain", 0) == 0; });
    return n;
}
size_t results(const Compiled& c, const std::string& op) {
    size_t n = 0;
    ir::forEach(static_cast<const ir::Region&>(c.kernel->body), [&](const ir::Inst* i) {
        if (i->op == ir::Op::Service && c.kernel->sites[static_cast<size_t>(i->site)].op == op)
            n = std::max(n, ir::resultKinds(*i).size());
    });
    return n;
}

TEST(Gradients, OnlyWhereDerivativesAreWanted) {
    for (int level : {0, 2}) {
        KernelOptions o;
        o.optimize = level;
        const auto plain = compile("surface s() { Ci = texture(\"a\") + texture(\"b\", u, v) + environment(\"c\", N); }", o);
        EXPECT_EQ(chains(plain), 0);
        EXPECT_EQ(results(plain, "texture"), 1u);
        EXPECT_EQ(results(plain, "environment"), 1u);
        const auto wanted = compile("surface s() { Ci = Du(color texture(\"a\", u, v)) + Dv(float environment(\"c\", N)); }", o);
        EXPECT_EQ(chains(wanted), 2);
        EXPECT_EQ(results(wanted, "texture"), 3u);
        EXPECT_EQ(results(wanted, "environment"), 4u);
        EXPECT_EQ(wanted.messages, "");
        const auto second =
            compile("surface s() { Ci = Dv(Du(color texture(\"a\", u, v))) + Du(Du(float environment(\"c\", N))); }", o);
        EXPECT_EQ(results(second, "texture"), 6u);
        EXPECT_EQ(results(second, "environment"), 10u);
        const auto mixed = compile("surface s() { float a = texture(\"a\"); float b = texture(\"b\", s, t); "
                                   "Ci = a + Dv(texture(\"c\", v, v)); if (u > 0.5) Ci += Du(b); }",
                                   o);
        EXPECT_EQ(chains(mixed), 2);
    }
}

// Where the coordinates are constant, so is the value.
TEST(Gradients, NotOfConstantCoordinates) {
    EXPECT_EQ(chains(compile("surface s() { Ci = Du(texture(\"a\", 0.25, 0.5)); }")), 0);
}

// Through variables, branches, loops, corners and names that are computed.
TEST(Gradients, Forms) {
    const auto c = compile(R"(surface s(string names[2] = {"a", "b"}; float which = 0;) {
    float h = 0, i;
    for (i = 0; i < which; i += 1) h += texture(names[i], s * i, t);
    if (which > 1) h += texture("c", u, v, u + du, v, u, v + dv, u + du, v + dv);
    vector d = N;
    h += environment("e", d, d + 1, d, d - 1);
    Ci = color(calculatenormal(P + h * N));
})");
    EXPECT_EQ(chains(c), 3);
    EXPECT_EQ(c.messages, "");
}

} // namespace

} // namespace gradients_test

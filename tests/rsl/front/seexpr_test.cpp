// Expressions of SeExpr as RSL (rsl/front/seexpr.h): what compiles, and what is said.
#include "rsl/front/ast.h"
#include "rsl/front/seexpr.h"
#include <gtest/gtest.h>

namespace seexpr_test {

using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

std::unique_ptr<Program> compiled(const std::string& text, std::string* said = nullptr) {
    Diagnostics d;
    const auto rsl = front::rslFromSeExpr(text, {{"c1", true}, {"k", false}}, {"x.rib", 3, 1}, d);
    auto p = rsl ? compileText(*rsl, "x", {}, d) : nullptr;
    std::string all;
    for (const Diagnostic& m : d.all()) all += toString(m);
    if (said) *said = all;
    else EXPECT_NE(p, nullptr) << text << '\n' << all << (rsl ? *rsl : "");
    return p;
}

TEST(SeExpr, ExpressionsCompile) {
    for (const char* text :
         {"$Cs ", "[1, 0, 0] * k", "$a = 3; $b = [a, 1, 2]; b[1] + $u", "k > 2 ? c1 : [0, 0, $v]",
          "$c = c1; if ($u < 0.5 && $v > 0.25) { $c = [1, 0, 0]; } else if (k == 1) { $c = 0.5; } else { $c *= 2; } $c",
          "noise($P * 3) ^ 2 + fbm(P, 4) - voronoi(10 * P)", "smoothstep($u, 0.2, 0.3) * cnoise([u, v, 0])",
          "mix(c1, [0, 1, 0], noise(u * 10, v * 10))", "abs(sin(P))  # a comment\n", "-(u % .5) / !k + ~k",
          "$x = 1; $x = [1, 2, 3]; x", "sqrt(($u-0.5)*($u-0.5)*4)*voronoi($P*10,2,0.5,0)", "fbm(vnoise($P*20) + $P*20/4)",
          "$colour = c1;\n$c = floor( 10 * $u ) +floor( 10 * $v );\nif( fmod( $c, 2.0 ) < 1.0 "
          ")\n{\n\t$colour=[1,0,0];\n}\n$colour\n",
          "cvoronoi(P, 5, .5, .2) + pvoronoi(P)",
          "remap(u, .5, .1, .2, 2) + gaussstep(u, 0, 1) + contrast(u, .7) + gamma(v, 2.2)",
          "saturate(c1, .5) + hsltorgb(rgbtohsl(c1)) + cfbm(P) + vfbm(P, 3)",
          "deg(rad(k)) + sind(30) + trunc(-1.5) + cbrt(k) + log10(k) + hypot(3, 4) + angle(P, N) + invert(u)",
          "expand(u, .2, .3) + compress(u, 1, 2) + norm(ortho(P, N))[0]"})
        compiled(text);
}

TEST(SeExpr, FaultsAreErrorsOfTheRequest) {
    for (const char* text :
         {"", "$nothing", "1 +", "f(3)", "mix(1)", "(1", "[1, 2, 3, 4]", "c1 = 2; c1", "1 2", "if (1) { $a = 1; ", "\"x\""}) {
        std::string said;
        EXPECT_EQ(compiled(text, &said), nullptr) << text;
        EXPECT_NE(said.find("x.rib:3:1"), std::string::npos) << text << said;
    }
}

TEST(SeExpr, HostileTextsEndWell) {
    std::string said;
    compiled(std::string(100'000, '('), &said);
    compiled(std::string(100'000, '-') + "1", &said);
    std::string deep = "P", sum = "1";
    for (int i = 0; i < 60; ++i) deep = "abs(" + deep + ")"; // each writes its argument three times
    EXPECT_EQ(compiled(deep, &said), nullptr);
    for (int i = 0; i < 100; ++i) sum += "+1";
    compiled(sum);
}

} // namespace
} // namespace seexpr_test

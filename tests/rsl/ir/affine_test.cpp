#include "compile.h"
#include <filesystem>
#include <fstream>
#include <sstream>

namespace affine_test {

using namespace alpenglow;
using namespace alpenglow::rsl;
using namespace alpenglow::rsl::ir;

namespace {

std::string shipped(const std::string& name) {
    std::ifstream f(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders/" + name + ".sl");
    std::stringstream s;
    s << f.rdbuf();
    return s.str();
}

void expectAffine(const Compiled& c, int emits) {
    if (!c.kernel) return;
    EXPECT_TRUE(c.kernel->facts.affine) << c.kernel->facts.whyNot;
    EXPECT_FALSE(c.kernel->facts.suspends);
    EXPECT_EQ(c.count(Op::Request), 0) << c.text();
    EXPECT_EQ(c.count(Op::Emit), emits) << c.text();
}

TEST(Affine, ShippedMaterialsUnderPath) {
    const std::pair<const char*, int> expected[] = {
        {"matte", 2}, {"plastic", 3}, {"paintedplastic", 3}, {"metal", 2}, {"constant", 0}};
    for (const auto& [name, emits] : expected) {
        SCOPED_TRACE(name);
        const Compiled c = compile(shipped(name), pathOptions());
        expectAffine(c, emits);
        if (c.kernel) EXPECT_TRUE(c.kernel->facts.direct.empty());
    }
}

// The principled surface and all materials of RIS.
TEST(Affine, PrincipledMaterials) {
    std::vector<std::string> names = {"standard"};
    for (const auto& f : std::filesystem::directory_iterator(std::string(ALPENGLOW_SOURCE_DIR) + "/shaders/ris"))
        if (f.path().extension() == ".sl") names.push_back("ris/" + f.path().stem().string());
    ASSERT_GE(names.size(), 20u);
    for (const std::string& name : names) {
        SCOPED_TRACE(name);
        const std::string text = shipped(name);
        if (text.find("surface " + name.substr(name.find('/') + 1)) == std::string::npos) continue; // a pattern
        const Compiled c = compile(text, pathOptions(), true, ALPENGLOW_SOURCE_DIR "/shaders/" + name + ".sl");
        ASSERT_NE(c.kernel, nullptr);
        EXPECT_TRUE(c.kernel->facts.affine) << c.kernel->facts.whyNot;
        EXPECT_FALSE(c.kernel->facts.suspends);
        EXPECT_TRUE(c.kernel->facts.direct.empty());
    }
}

TEST(Affine, SlprojectMaterial) { expectAffine(compile(shipped("slmaterial"), pathOptions()), 4); }

TEST(Affine, SumInLoopScaledBefore) {
    const Compiled c = compile(
        "surface s(float n = 4) { color sum = 0; float i; for (i = 0; i < n; i += 1) sum += trace(P, N); Ci = Cs * sum; }");
    expectAffine(c, 1);
    EXPECT_EQ(c.count(Op::Rescale), 0) << c.text();
}

TEST(Affine, SumDividedByCountAfterLoop) {
    const Compiled c = compile("surface s(float n = 4) { color sum = 0; float k = 0; float i;"
                               " for (i = 0; i < n; i += 1) { sum += trace(P, N); k += i * s; } Ci = sum / k; }");
    expectAffine(c, 1);
    EXPECT_EQ(c.count(Op::Rescale), 1) << c.text();
    EXPECT_EQ(c.count(Op::Mark), 2) << c.text();
}

TEST(Affine, SeveralSumsDividedByCountAfterLoop) {
    const char* const twoSums = "surface s(float n = 4) { color a = 0, b = 0; float k = 0; float i;"
                                " for (i = 0; i < n; i += 1) { a += trace(P, N); b += trace(P, -N) * i; k += i * s; }"
                                " Ci = a / k + b * (1 - 1 / k); }";
    const Compiled c = compile(twoSums);
    expectAffine(c, 2);
    EXPECT_EQ(c.count(Op::Loop), 2) << c.text();
    EXPECT_EQ(c.count(Op::Rescale), 2) << c.text();
    const Compiled coupled =
        compile("surface s(float n = 4) { color a = 0, b = 0; float k = 0; float i;"
                " for (i = 0; i < n; i += 1) { a += trace(P, N); b += a * i; k += i * s; } Ci = a / k + b * (1 - 1 / k); }");
    EXPECT_TRUE(coupled.kernel->facts.suspends);
    EXPECT_NE(coupled.kernel->facts.whyNot.find("sums up more than one"), std::string::npos) << coupled.kernel->facts.whyNot;
}

TEST(Affine, BlendOverLayersRescalesEarlierTurns) {
    const Compiled c = compile(
        "surface s(float n = 4) { color x = 0; float i; for (i = 0; i < n; i += 1) x = mix(x, trace(P, N), 0.25 * s); Ci = x; }");
    expectAffine(c, 1);
    EXPECT_EQ(c.count(Op::Rescale), 1) << c.text();
}

TEST(Affine, FunctionsWithOutputsAndVaryingIf) {
    expectAffine(compile("void both(vector d; output color a, b) { a = trace(P, d); b = 0.5 * trace(P, -d); }"
                         "surface s() { color a, b; both(N, a, b); if (s > 0.5) Ci = a * Cs; else Ci = b + a; }"),
                 2);
    expectAffine(
        compile("surface s() { color r = 0; float k = 0; if (s > 0.5) { k = sin(t); r = trace(P, N); } Ci = mix(Cs, r, k); }"),
        1);
}

TEST(Affine, ComponentsStayInPlace) {
    expectAffine(compile("surface s() { color c = trace(P, N); Ci = color(c[0] * 0.5, c[1], c[2] * s); }"), 1);
    const Compiled c = compile("surface s() { color c = trace(P, N); Ci = color(c[1], c[1], c[1]); }");
    EXPECT_FALSE(c.kernel->facts.affine);
}

TEST(Affine, NotAffineSaysWhyAndSuspends) {
    const std::pair<const char*, const char*> cases[] = {
        {"surface s() { color c = trace(P, N);\n if (c[0] > 0.5) Ci = 1; }", "compared"},
        {"surface s() { color c = trace(P, N); Ci = c * c; }", "multiplied"},
        {"surface s() { color c = trace(P, N); Ci = Cs / c; }", "divided"},
        {"surface s() { color c = trace(P, N); Ci = c; Oi = c; }", "Oi"},
        {"surface s() { float d; color c = trace(P, N, d); Ci = c * d; }", "another result"},
        {"surface s() { color c = trace(P, N); Ci = max(c, color(0.5)); }", "max"},
        {"surface s(output varying color extra = 0) { extra = trace(P, N); Ci = extra; }", ""},
    };
    for (const auto& [source, why] : cases) {
        SCOPED_TRACE(source);
        KernelOptions o;
        if (!*why) o.outputs = {"Ci", "extra"};
        const Compiled c = compile(source, o);
        if (!c.kernel) continue;
        EXPECT_FALSE(c.kernel->facts.affine);
        EXPECT_TRUE(c.kernel->facts.suspends);
        EXPECT_NE(c.kernel->facts.whyNot.find(why), std::string::npos) << c.kernel->facts.whyNot;
        EXPECT_EQ(c.count(Op::Emit), 0);
        EXPECT_GE(c.count(Op::Request), 1);
    }
}

TEST(Affine, LobeUsedNonlinearlyStaysDirect) {
    const Compiled c = compile(
        "surface s() { color d = diffuse(normalize(N)); Ci = (d[0] > 0.5) ? color(1) : color(0); Ci += specular(N, -I, 0.1); }",
        pathOptions());
    ASSERT_NE(c.kernel, nullptr);
    ASSERT_EQ(c.kernel->facts.direct.size(), 1u);
    EXPECT_NE(c.kernel->facts.direct[0].text().find("diffuse, line 1"), std::string::npos) << c.kernel->facts.direct[0].text();
    EXPECT_EQ(c.count(Op::LightLoop), 1);
    EXPECT_EQ(c.sites(Op::Request, "specular"), 1) << c.text();
}

TEST(Affine, CallsBetweenTwoLobesAreNotTakenForThem) {
    // Services have site numbers too: with 63 of them the two lobes are 64 sites apart.
    for (int calls : {0, 62, 63, 64, 127, 191}) {
        std::string text = "surface s() { normal n = normalize(N); uniform float x, sum = 0;\nCi = diffuse(n);\n";
        for (int i = 0; i < calls; ++i) text += "if (attribute(\"user:a" + std::to_string(i) + "\", x) != 0) sum += x;\n";
        const Compiled c = compile(text + "color h = specular(n, -I, 0.1); if (h[0] > 0.5) Ci += sum; }", pathOptions());
        ASSERT_NE(c.kernel, nullptr);
        ASSERT_EQ(c.kernel->facts.direct.size(), 1u) << calls << " calls";
        EXPECT_EQ(c.kernel->facts.direct[0].text().rfind("specular", 0), 0u)
            << calls << " calls: " << c.kernel->facts.direct[0].text();
    }
}

TEST(Affine, MoreLobesThanAWordHasBits) {
    // Each of the seventy keeps its own dependence; the one that is not affine is the last.
    std::string text = "surface s() { normal n = normalize(N); Ci = 0;\n";
    for (int i = 0; i < 70; ++i) text += "Ci += " + std::to_string(i + 1) + " * specular(n, -I, 0.1);\n";
    const Compiled c = compile(text + "color h = diffuse(n); if (h[0] > 0.5) Ci += 1; }", pathOptions());
    ASSERT_NE(c.kernel, nullptr);
    ASSERT_EQ(c.kernel->facts.direct.size(), 1u);
    EXPECT_EQ(c.kernel->facts.direct[0].text().rfind("diffuse", 0), 0u) << c.kernel->facts.direct[0].text();
    EXPECT_EQ(c.sites(Op::Request, "specular") + c.sites(Op::Emit, "specular"), 70);
}

TEST(Affine, IlluminanceUnderPathEmitsShadows) {
    const Compiled c = compile("surface s(float Kd = 0.5) { color sum = 0; illuminance(P, N, PI/2) { sum += Cl * (normalize(L) . "
                               "N); } Ci = Cs * Kd * sum; }",
                               pathOptions());
    expectAffine(c, 1);
    EXPECT_EQ(c.sites(Op::Emit, "lightvisibility"), 1);
    EXPECT_EQ(c.count(Op::Rescale), 0) << c.text();
}

} // namespace

} // namespace affine_test

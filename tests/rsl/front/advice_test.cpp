// Fix-its: what an editor does with them is a program without the fault. Hints where a line shows what was meant.
#include "base/limits.h"
#include "front_helpers.h"
#include <algorithm>
#include <filesystem>
#include <fstream>

namespace advice_test {

namespace fs = std::filesystem;
using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

std::vector<Diagnostic> said(const std::string& text, bool lint) {
    FrontOptions o;
    o.lint = lint;
    return compileSnippet(text, o).messages;
}

/// The text with the fix-its of all messages, the last first.
std::string mended(std::string text, bool lint) {
    std::vector<FixIt> all;
    for (const Diagnostic& d : said(text, lint)) all.insert(all.end(), d.fixes.begin(), d.fixes.end());
    for (size_t k = all.size(); k-- > 0;) {
        size_t at = 0;
        for (int line = 1; line < all[k].place.line; ++line) at = text.find('\n', at) + 1;
        text.replace(at + size_t(all[k].place.column) - 1, size_t(all[k].length), all[k].text);
    }
    return text;
}

struct Case {
    const char* body;
    const char* mended;
    bool lint = false;
};

constexpr Case kCases[] = {
    {"Ci = diffues(N);", "Ci = diffuse(N);"},
    {"float roughnes = 1; Ci = rougnes;", "float roughnes = 1; Ci = roughnes;"},
    {"colour c = 1; Ci = c;", "color c = 1; Ci = c;"},
    {"double x = 1; Ci = x;", "float x = 1; Ci = x;"},
    {"vec3 x = 1; Ci = color x;", "vector x = 1; Ci = color x;"},
    {"Ci = Cs", "Ci = Cs;"},
    {"color c = Cs Ci = c;", "color c = Cs; Ci = c;"},
    {"Ci = Cs   Oi = Os;", "Ci = Cs;   Oi = Os;"},
    {"Ci = max(Cs, Os;", "Ci = max(Cs, Os);"},
    {"Ci = ((Cs);", "Ci = ((Cs));"},
    {"Ci = max(Cs; Os);", "Ci = max(Cs, Os);"},
    {"if (u > 0 and v > 0) Ci = 1;", "if (u > 0 && v > 0) Ci = 1;"},
    {"Ci = P;", "Ci = color P;"},
    {"color c = N; Ci = c;", "color c = color N; Ci = c;"},
    {"float x = P.z; Ci = x;", "float x = P[2]; Ci = x;"},
    {"Ci = Cs.g;", "Ci = Cs[1];"},
    {"Ci = 1.5f;", "Ci = 1.5;"},
    {"float a = u, b = v; if (a = b) Ci = 1;", "float a = u, b = v; if (a == b) Ci = 1;", true},
    {"Ci = mix(Cs, Os, u,);", "Ci = mix(Cs, Os, u);", true},
    {"Ci = texture(\"a\", \"blurr\", 1);", "Ci = texture(\"a\", \"blur\", 1);", true},
    {"Ci = texture(\"a\", \"filter\", \"gausian\");", "Ci = texture(\"a\", \"filter\", \"gaussian\");", true},
    {"float x = area(P, \"dicin\"); Ci = x;", "float x = area(P, \"dicing\"); Ci = x;", true},
};

std::string shader(const std::string& body) { return "surface s()\n{\n    " + body + "\n}\n"; }

} // namespace

TEST(FixIts, MendTheProgram) {
    for (const Case& c : kCases) {
        EXPECT_FALSE(said(shader(c.body), c.lint).empty()) << c.body;
        EXPECT_EQ(mended(shader(c.body), c.lint), shader(c.mended)) << c.body;
        const auto rest = said(shader(c.mended), c.lint);
        EXPECT_TRUE(rest.empty()) << c.mended << ": " << rest[0].message;
    }
    const std::string members = "struct A { float x; };\nsurface s() { A a; a.x = 1; Ci = a->x; }\n";
    EXPECT_EQ(mended(members, false), "struct A { float x; };\nsurface s() { A a; a->x = 1; Ci = a->x; }\n");
}

// Where more than one thing may be meant nothing is offered.
TEST(FixIts, NotWhereItIsNotObvious) {
    for (const char* body : {"Ci = P + N;", "Ci = (Cs));", "Ci = u v w;", "float x = nothinglikethis; Ci = x;", "Ci = foo.bar;"})
        for (const Diagnostic& d : said(shader(body), false))
            if (d.id != "expected-semicolon" || d.message.find(" before ')'") != std::string::npos) {
                EXPECT_TRUE(d.fixes.empty()) << body << ": " << d.fixes[0].text;
            }
}

TEST(Hints, SayWhatWasMeant) {
    const std::pair<const char*, const char*> cases[] = {
        {"surface s() { string n = 'abc'; Ci = 1; }", "double quotes"},
        {"surface s() { Ci = Cs.r; }", "comp(v, 0)"},
        {"surface s() { if (u > 0.5) then Ci = 1; }", "there is no 'then'"},
        {"surface s() { float i; for (i = 0, i < 3, i = i + 1) Ci = 1; }", "separated by ';'"},
        {"surface s(color c = {1, 0, 0};) { Ci = c; }", "a triple is written (1, 2, 3)"},
        {"displacement s() { Ci = 1; }", "surface, volume, imager"},
        {"color c = 1;\nsurface s() { Ci = c; }", "inside of shaders and functions"},
        {"surface s() { rayserver(1); }", "--dialect bmrt"},
        {"float f(float x) { return x; }\nshader t() { }", ""},
        {"surface s() { Ci = (1, 2, 3) + foo(1); }", ""},
    };
    for (const auto& [text, hint] : cases) {
        bool found = false;
        for (const Diagnostic& d : said(text, false)) found |= d.hint.find(hint) != std::string::npos;
        EXPECT_TRUE(found || !*hint) << text;
    }
    // A name that is right as it stands is no hint.
    for (const Diagnostic& d : said("surface t float k = 1; { Ci = k; }", false))
        EXPECT_EQ(d.hint.find("'surface'"), std::string::npos) << d.hint;
}

// The names of the specification have no prefix; texture3d() gives what it reads; a parameter is reported once, however often it
// is changed.
TEST(Warnings, NotWhereNothingIsWrong) {
    const auto count = [](const std::string& body, const std::string& what, const std::string& before = "") {
        const std::vector<Diagnostic> all = said(before + shader(body), true);
        return std::count_if(all.begin(), all.end(),
                             [&](const Diagnostic& d) { return d.message.find(what) != std::string::npos; });
    };
    EXPECT_EQ(
        count("float c[2] = {0, 1}; option(\"Clipping\", c); float f[3] = {0, 0, 0}; option(\"Format\", f); Ci = c[0] + f[0];",
              "knows nothing"),
        0);
    EXPECT_EQ(count("float a = 0; attribute(\"Sides\", a); Ci = a;", "knows nothing"), 0);
    EXPECT_EQ(count("float a = 0; option(\"Ri:Cliping\", a); Ci = a;", "knows nothing"), 1);
    EXPECT_EQ(count("float x; color c; texture3d(\"f.ptc\", P, N, \"_x\", x, \"_c\", c); Ci = c * x;", "before it has a value"),
              0);
    EXPECT_EQ(count("float x[2]; texture3d(\"f.ptc\", P, N, \"_x\", x[1]); Ci = x[1];", "before it has a value"), 0);
    EXPECT_EQ(count("float x; bake3d(\"f.ptc\", \"\", P, N, \"_x\", x);", "before it has a value"), 1);
    EXPECT_EQ(count("Ci = f(P, 1);", "is not output",
                    "float f(vector p; float r) { p[0] = abs(p[0]); p *= 2; p[1] -= r; r = 2; return xcomp(p) * r; }\n"),
              2);
}

// What a parameter without a default is.
TEST(Warnings, SayWhatIsThere) {
    const std::pair<const char*, const char*> cases[] = {{"string map", "it is empty unless set"},
                                                         {"float k", "it is zero unless set"},
                                                         {"matrix m", "it is zero unless set"},
                                                         {"shader s", "it is null unless set"}};
    for (const auto& [parameter, what] : cases) {
        const auto all = said("surface t(" + std::string(parameter) + ";) { }\n", false);
        ASSERT_EQ(all.size(), 1u) << parameter;
        EXPECT_NE(all[0].message.find(what), std::string::npos) << all[0].message;
        EXPECT_EQ(all[0].id, "no-default");
    }
}

TEST(Includes, CapitalsDoNotMatter) {
    std::string name = (fs::temp_directory_path() / "alpenglow-include-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    fs::create_directories(fs::path(name) / "sub");
    std::ofstream(fs::path(name) / "sub" / "MyNoise.h") << "float mynoise(float x) { return x; }\n";
    FrontOptions o;
    o.includePaths = {name};
    const auto c = compileSnippet("#include \"sub/mynoise.H\"\nsurface s() { Ci = mynoise(1); }\n", o);
    EXPECT_EQ(c.errors(), 0) << c.text();
    ASSERT_EQ(c.messages.size(), 1u);
    EXPECT_EQ(c.messages[0].id, "pp-include-elsewhere");
    ASSERT_EQ(c.messages[0].fixes.size(), 1u);
    EXPECT_EQ(c.messages[0].fixes[0].text, "\"sub/MyNoise.h\"");
    // In a folder of very many files it is not sought for ever: the limit is there, and no file is found by chance behind it.
    EXPECT_GT(limits::kFolderEntries, 1000);
    fs::remove_all(name);
}

// A line of a megabyte: the message has what stands around its place.
TEST(Excerpts, OfVeryLongLines) {
    std::string text = "surface s() { Ci = 0";
    for (int k = 0; k < 100'000; ++k) text += " + 1";
    const auto messages = said(text.substr(0, 100'000) + "; Ci = nosuch; } // " + std::string(1 << 20, 'x'), false);
    ASSERT_FALSE(messages.empty());
    for (const Diagnostic& d : messages) {
        if (d.id != "undeclared") continue;
        const std::string shown = toString(d);
        EXPECT_NE(shown.find("Ci = nosuch; }"), std::string::npos);
        EXPECT_LT(shown.size(), size_t(4 * limits::kExcerptColumns));
        EXPECT_EQ(d.length, 6);
    }
}

} // namespace advice_test

// The preprocessor: docs/language.md.
#include "front_helpers.h"
#include "rsl/front/preprocessor.h"
#include <filesystem>
#include <fstream>

namespace alpenglow::rsl::front_preprocessor_test {
namespace {

struct Case {
    const char* text;
    const char* tokens;
};

/// Tokens on one line, separated by blanks.
std::string tokens(const std::string& text, const FrontOptions& options = {}) {
    front::SourceSet set;
    const auto p = front::preprocess(set, set.add("t.sl", text), options);
    std::string s;
    for (const auto& t : p.tokens)
        if (t.kind != front::Tok::End) s += (s.empty() ? "" : " ") + std::string(t.text);
    Diagnostics d;
    set.flush(d);
    for (const auto& m : d.all()) s += " !" + m.message;
    return s;
}

const Case kCases[] = {
    {"a /* b */ c // d\ne", "a c e"},
    {"#define X 1\nX Y X", "1 Y 1"},
    {"#define F(a, b) a + b\nF(1, 2) F (3, (4, 5)) F", "1 + 2 3 + ( 4 , 5 ) F"},
    {"#define F() 7\nF() F", "7 F"},
    {"#define F (x)\nF", "( x )"},
    {"#define X Y\n#define Y X\nX Y", "X Y"},
    {"#define X X + 1\nX", "X + 1"},
    {"#define F(x) x x\n#define G F(1)\nG", "1 1"},
    {"#define F(x) x\nF(F(F(2)))", "2"},
    {"#define CAT(a, b) a ## b\nCAT(foo, bar) CAT(1, 2) CAT(, x)", "foobar 12 x"},
    {"#define S(x) #x\nS(a + \"b\")", "\"a + \\\"b\\\"\""},
    {"#define X 1\n#undef X\nX", "X"},
    {"#ifdef X\na\n#else\nb\n#endif", "b"},
    {"#ifndef X\na\n#else\nb\n#endif", "a"},
    {"#if 0\na\n#elif 1\nb\n#elif 1\nc\n#else\nd\n#endif", "b"},
    {"#if 0\n#if 1\na\n#else\nb\n#endif\n#else\nc\n#endif", "c"},
    {"#if 0\nit's \"open\n#endif\nx", "x"},
    {"#if defined(ALPENGLOW) && defined DELIGHT\nx\n#endif", "x"},
    {"#if (1 + 2) * 3 == 9 && !0 && 7 % 4 == 3 && (1 ? 2 : 3) == 2\nx\n#endif", "x"},
    {"#define N 3\n#if N > 2\nx\n#endif", "x"},
    {"#if UNKNOWN\nx\n#endif\ny", "y"},
    {"a\\\nb c\\\r\nd", "ab cd"},
    {"#define LONG 1 + \\\n 2\nLONG", "1 + 2"},
    {"\"a\\\"b\" x", "\"a\\\"b\" x"},
    {"1.5e-3 .5 2. 1e5 a.b", "1.5e-3 .5 2. 1e5 a . b"},
    {"a\r\nb\r\n", "a b"},
    {"\xef\xbb\xbfsurface", "surface"},
    {"__LINE__\n\n__LINE__ __FILE__", "1 3 \"t.sl\""},
    {"#line 20\n__LINE__", "20"},
    {"#pragma once\n#pragma foo bar\nx", "x"},
    {"#define F(x, ...) g(x, __VA_ARGS__)\nF(1, 2, 3)", "g ( 1 , 2 , 3 )"},
    {"#define EMPTY\nEMPTY x EMPTY", "x"},
    {"#define F(x) [x]\nF(\n1\n)", "[ 1 ]"},
    {"#if 1/0\n#endif\nx", "x !division by zero in the condition"},
    {"#define F(x) x\nF(1", "F !the call of macro 'F' has no closing ')'"},
    {"#define A 1\n#define A 2\nA", "2 !macro 'A' is defined again with another meaning"},
};

TEST(FrontPreprocessor, Tokens) {
    for (const Case& c : kCases) EXPECT_EQ(tokens(c.text), c.tokens) << c.text;
}

TEST(FrontPreprocessor, Defines) {
    FrontOptions o;
    o.defines = {{"QUALITY", "3"}};
    EXPECT_EQ(tokens("QUALITY", o), "3");
}

TEST(FrontPreprocessor, StringEscapes) { EXPECT_EQ(front::stringValue("\"a\\n\\t\\\\\\\"\\101\""), "a\n\t\\\"A"); }

TEST(FrontPreprocessor, IncludesKeepPlaces) {
    const auto folder = std::filesystem::path(::testing::TempDir()) / "alpenglow_front_include";
    std::filesystem::create_directories(folder / "lib");
    std::ofstream(folder / "lib" / "h.h") << "float helper(float x) {\n  return y;\n}\n";
    std::ofstream(folder / "self.h") << "#include \"self.h\"\n";
    std::ofstream(folder / "main.sl") << "#include <h.h>\nsurface s() { Ci = helper(1); }\n";
    std::ofstream(folder / "loop.sl") << "#include \"self.h\"\nsurface s() {}\n";
    FrontOptions o;
    o.includePaths = {(folder / "lib").string()};
    Diagnostics d;
    EXPECT_FALSE(compileFile((folder / "main.sl").string(), o, d));
    ASSERT_EQ(d.errors(), 1);
    EXPECT_EQ(std::filesystem::path(d.all()[0].place.file).filename(), "h.h");
    EXPECT_EQ(d.all()[0].place.line, 2);
    EXPECT_EQ(d.all()[0].sourceLine, "  return y;");
    Diagnostics loop;
    EXPECT_FALSE(compileFile((folder / "loop.sl").string(), o, loop));
    EXPECT_EQ(loop.errors(), 1);
    std::filesystem::remove_all(folder);
}

TEST(FrontPreprocessor, DependenciesAndText) {
    const auto c = compileSnippet("#define X 1\nsurface s() { Ci = X; }\n#pragma annotation \"author\" \"me\"\n");
    ASSERT_TRUE(c.program);
    EXPECT_EQ(c.program->preprocessed, "surface s ( ) { Ci = 1 ; }\n#pragma annotation \"author\" \"me\"");
    ASSERT_EQ(c.program->shaders[0]->annotations.size(), 1u);
    EXPECT_EQ(c.program->shaders[0]->annotations[0].second, "me");
}

/// Old Macs end lines with a carriage return alone, others put one before the line feed.
TEST(FrontPreprocessor, LineEndsOfEverySystem) {
    const std::string lines[] = {"#define X 1 // one", "surface s() {", "Ci = X;", "/* two", "lines */ Oi = y; }", ""};
    for (const std::string end : {"\n", "\r\n", "\r", "\r\r\n"}) {
        std::string text;
        for (const std::string& l : lines) text += l + end;
        const auto c = compileSnippet(text.c_str());
        ASSERT_EQ(c.messages.size(), 1u) << end.size();
        EXPECT_EQ(c.messages[0].place.line, 5);
        EXPECT_EQ(c.messages[0].place.column, 15);
        EXPECT_EQ(c.messages[0].sourceLine, "lines */ Oi = y; }");
    }
}

TEST(FrontPreprocessor, AnnotationsWithoutQuotes) {
    const auto c =
        compileSnippet("#pragma annotation Kd \"how \" \"bright\"\n#pragma annotation \"Ks\" slider 0 to 1\nsurface s() {}\n");
    ASSERT_TRUE(c.program);
    const std::vector<std::pair<std::string, std::string>> expected = {{"Kd", "how bright"}, {"Ks", "slider 0 to 1"}};
    EXPECT_EQ(c.program->shaders[0]->annotations, expected);
    EXPECT_EQ(c.messages.size(), 1u);
}

} // namespace
} // namespace alpenglow::rsl::front_preprocessor_test

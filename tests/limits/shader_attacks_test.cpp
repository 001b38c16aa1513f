// Small shaders that were found to hang, to crash, or to take all memory.
#include "../nightly.h"
#include "../sanitized.h"
#include "base/limits.h"
#include "rsl/compiler.h"
#include "rsl/evaluate.h"
#include "rsl/front/ast.h"
#include "rsl/ir/build.h"
#include "rsl/services_basic.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace shader_attacks_test {

namespace fs = std::filesystem;
using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

struct Folder {
    fs::path path;
    Folder() {
        std::string t = (fs::temp_directory_path() / "alpenglow-attacks-XXXXXX").string();
        path = mkdtemp(t.data());
    }
    ~Folder() {
        std::error_code e;
        fs::remove_all(path, e);
    }
    void put(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

std::string all(const Diagnostics& d) {
    std::string s;
    for (const Diagnostic& m : d.all()) s += toString(m);
    return s;
}

/// The messages about a text; "" when it compiles without any.
std::string complaint(const std::string& text, const FrontOptions& options = {}) {
    Diagnostics d;
    auto p = compileText(text, "t.sl", options, d);
    EXPECT_EQ(p == nullptr, d.errors() > 0);
    return all(d);
}

std::string repeat(const std::string& s, size_t n) {
    std::string r;
    for (size_t i = 0; i < n; ++i) r += s;
    return r;
}

bool says(const std::string& messages, const std::string& part) { return messages.find(part) != std::string::npos; }

std::string number(size_t n) { return std::to_string(n); }

} // namespace

TEST(ShaderAttacks, FileThatIncludesItselfTwice) {
    Folder f;
    f.put("x.h", "#include \"x.h\"\n#include \"x.h\"\n");
    FrontOptions o;
    o.includePaths = {f.path.string()};
    // 2^64 inclusions at the limit of their depth: there is an end to it.
    const std::string m = complaint("#include \"x.h\"\nsurface s() { Ci = 1; }", o);
    EXPECT_TRUE(says(m, "nested more than " + number(size_t(limits::kIncludeDepth)))) << m.substr(0, 2000);
    EXPECT_TRUE(says(m, "x.h:")) << m.substr(0, 2000);
    // 2^20 files without an error of their own.
    for (int i = 0; i < 20; ++i) {
        const std::string next = "#include \"b" + std::to_string(i + 1) + ".h\"\n";
        f.put("b" + std::to_string(i) + ".h", next + next);
    }
    f.put("b20.h", "\n");
    const std::string many = complaint("#include \"b0.h\"\nsurface s() { Ci = 1; }", o);
    EXPECT_TRUE(says(many, "more than " + number(size_t(limits::kIncludes)) + " files are included")) << many.substr(0, 2000);
    EXPECT_TRUE(says(many, ".h:")) << many.substr(0, 2000);
}

TEST(ShaderAttacks, LargeFileManyTimes) {
    Folder f;
    const size_t bytes = 4u << 20;
    f.put("big.h", "/*" + std::string(bytes, ' ') + "*/\n");
    FrontOptions o;
    o.includePaths = {f.path.string()};
    const size_t fits = limits::kSourceBytes / bytes - 1;
    EXPECT_EQ(complaint(repeat("#include \"big.h\"\n", fits) + "surface s() { Ci = 1; }", o), "");
    const std::string m = complaint(repeat("#include \"big.h\"\n", fits + 8) + "surface s() { Ci = 1; }", o);
    EXPECT_TRUE(says(m, "more than " + number(limits::kSourceBytes) + " bytes together")) << m;
}

TEST(ShaderAttacks, MessagesAboutOneLongLine) {
    // Each message would keep the whole line: 24,000 times 240 KB.
    Diagnostics d;
    compileText("surface s() { float q = 0; " + repeat("float x=q; ", 24'000) + "Ci = q; }", "t.sl", {}, d);
    size_t kept = 0;
    for (const Diagnostic& m : d.all()) kept += m.sourceLine.size();
    EXPECT_GT(d.all().size(), 0u);
    EXPECT_LE(kept, limits::kExcerptBytes + limits::kExcerptLine + (size_t(1) << 20));
}

TEST(ShaderAttacks, StructuresThatDouble) {
    auto doubling = [](int n) {
        std::string text = "struct S0 { float x = 0; }\n";
        for (int i = 1; i <= n; ++i)
            text += "struct S" + std::to_string(i) + " { S" + std::to_string(i - 1) + " a; S" + std::to_string(i - 1) + " b; }\n";
        return complaint(text + "surface s() { S" + std::to_string(n) + " v; Ci = 1; }\n");
    };
    EXPECT_EQ(doubling(6), "");
    const std::string m = doubling(40);
    EXPECT_TRUE(says(m, "no more than " + number(limits::kStructMembers) + " members")) << m.substr(0, 2000);
    EXPECT_TRUE(says(m, "t.sl:12:") || says(m, "t.sl:13:") || says(m, "t.sl:11:")) << m.substr(0, 2000);
    EXPECT_TRUE(says(m, "[struct-members]")) << m.substr(0, 2000);
}

TEST(ShaderAttacks, MethodsThatCallEachOther) {
    // Each method calls the one before it; written in either order.
    auto chain = [](int n, bool backwards) {
        std::string text;
        for (int i = 0; i < n; ++i) {
            const std::string name = "m" + std::to_string(i);
            const std::string m =
                "public float " + name + "(float x) { return " + (i ? "m" + std::to_string(i - 1) + "(x) + 1" : "x") + "; }\n";
            text = backwards ? m + text : text + m;
        }
        return complaint("class c() {\n" + text + "public void surface(output color Ci, Oi) { Ci = m" + std::to_string(n - 1) +
                         "(u); }\n}\n");
    };
    for (bool backwards : {false, true}) {
        EXPECT_EQ(chain(limits::kCallDepth / 2, backwards), "");
        const std::string m = chain(4000, backwards);
        EXPECT_TRUE(says(m, "nested more than " + std::to_string(limits::kCallDepth) + " deep")) << m.substr(0, 2000);
        EXPECT_TRUE(says(m, "[too-deep]")) << m.substr(0, 2000);
    }
}

TEST(ShaderAttacks, FunctionsInsideOfShaders) {
    auto chain = [](int n) {
        std::string text = "surface s() {\n";
        for (int i = 0; i < n; ++i)
            text += "float f" + std::to_string(i) + "(float x) { return " + (i ? "f" + std::to_string(i - 1) + "(x) + 1" : "x") +
                    "; }\n";
        return complaint(text + "Ci = f" + std::to_string(n - 1) + "(u);\n}\n");
    };
    EXPECT_EQ(chain(limits::kCallDepth / 2), "");
    const std::string m = chain(4000);
    EXPECT_TRUE(says(m, "nested more than " + std::to_string(limits::kCallDepth) + " deep")) << m.substr(0, 2000);
}

TEST(ShaderAttacks, OneValueForLargeArrays) {
    // The value is kept once, not once an element.
    Diagnostics d;
    auto p = compileText(
        "surface s() {\n" +
            repeat("{ float a[16384] = 0, b[16384] = {1, ...}, c[16384] = {2}; Ci = a[3] + b[4] + c[5]; }\n", 100) + "}\n",
        "t.sl", {}, d);
    ASSERT_TRUE(p) << all(d);
    std::function<size_t(const Expr&)> nodes = [&](const Expr& e) {
        size_t n = 1;
        for (const ExprPtr& a : e.args)
            if (a) n += nodes(*a);
        return n;
    };
    std::function<size_t(const Stmt&)> inStatement = [&](const Stmt& s) {
        size_t n = 1;
        for (const auto& x : s.declarators)
            if (x.init) n += nodes(*x.init);
        for (const auto& b : s.body)
            if (b) n += inStatement(*b);
        return n;
    };
    EXPECT_LT(inStatement(*p->shaders[0]->body), 100u * 100);
}

TEST(ShaderAttacks, ElementsThatAreNotWritten) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    for (int n : {4, 300}) {
        const std::string length = std::to_string(n), last = std::to_string(n - 1);
        for (const auto& [init, sum] : {std::pair{"5", 10}, {"{5, ...}", 10}, {"{1, 2, ...}", 3}, {"{7}", 7}, {"v0 + 2", 10}}) {
            Diagnostics d;
            const Evaluation e =
                evaluate(compiler, "float v0 = 3; float a[" + length + "] = " + init + ";", "a[0] + a[" + last + "]", {}, d);
            ASSERT_TRUE(e.ok) << all(d);
            EXPECT_EQ(e.numbers[0], sum) << init << " for " << n;
            EXPECT_EQ(all(d), "");
        }
    }
}

TEST(ShaderAttacks, ThousandsOfEarlyReturns) {
    // f(x) is the first of the numbers 0, 2, 4 ... that x is below, plus what was added before it; g leaves a loop the same way.
    auto text = [](int n) {
        std::string f = "float f(float x) { float a = 0.5;\n",
                    g = "float g(float x) { float r = 0, i; for (i = 0; i < 2; i += 1) {\n";
        for (int i = 0; i < n; ++i) {
            const std::string k = std::to_string(2 * i), name = "b" + std::to_string(i);
            f += "if (x < " + k + ") return " + k + " + a;\n" +
                 (i % 100 == 50 ? "float " + name + " = a; a = " + name + " + 1;\n" : "");
            g += "if (x < " + k + ") { r = " + k + "; break; }\n";
        }
        return f + "return -1; }\n" + g + "} return r; }\n";
    };
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    size_t turn = 0;
    for (int x : {-1, 1, 98, 102, 257, 255, 256, 333, 597, 600, 700}) {
        if (!chosen(turn++, 2)) continue;
        const Evaluation e = evaluate(compiler, text(300) + "float at = " + std::to_string(x) + " + u * 0;", "f(at)", {}, d);
        ASSERT_TRUE(e.ok) << all(d);
        // Below 2 i for the first i with 2 i > x; every hundredth i has added one.
        int i = 0;
        while (i < 300 && !(x < 2 * i)) ++i;
        const int added = i > 250 ? 3 : i > 150 ? 2 : i > 50 ? 1 : 0;
        EXPECT_EQ(e.numbers[0], i == 300 ? -1 : float(2 * i + added) + 0.5f) << x;
        const Evaluation h = evaluate(compiler, text(300) + "float at = " + std::to_string(x) + " + u * 0;", "g(at)", {}, d);
        ASSERT_TRUE(h.ok) << all(d);
        EXPECT_EQ(h.numbers[0], i == 300 ? 0 : float(2 * i)) << x;
    }
    if (kSanitized) return;
    ASSERT_TRUE(evaluate(compiler, text(3000), "f(u)", {}, d).ok) << all(d); // ctest ends what hangs
}

TEST(ShaderAttacks, PatternsOfMatch) {
    std::string error;
    EXPECT_FALSE(matchText("(((((a{1,9}){1,9}){1,9}){1,9}){1,9}b", "aaaa", &error));
    EXPECT_TRUE(says(error, "too large")) << error;
    // Only so many patterns are kept, and all of them work.
    for (size_t i = 0; i < limits::kPatternCache + 10; ++i) EXPECT_TRUE(matchText("^x" + number(i) + "$", "x" + number(i)));
}

TEST(ShaderAttacks, TextsMadeAtRunTime) {
    if (kSanitized) GTEST_SKIP() << "takes half a gibibyte";
    const size_t each = 64u << 20;
    bool full = false;
    size_t kept = 0;
    std::string text(each + 1, '.');
    for (size_t i = 0; i <= limits::kRuntimeStrings / each && !full; ++i) {
        text.replace(0, 4, number(1000 + i));
        const int32_t id = internRuntimeString(text, full);
        if (full) {
            EXPECT_EQ(id, 0);
        } else {
            ++kept;
            EXPECT_EQ(internRuntimeString(text, full), id);
            EXPECT_EQ(internedString(id).size(), text.size());
        }
    }
    EXPECT_TRUE(full);
    EXPECT_EQ(kept, limits::kRuntimeStrings / each - 1); // the table's own places are counted, too
    full = false;
    EXPECT_NE(internString("a text of the shader itself"), 0); // those are not limited
}

TEST(ShaderAttacks, TooManyLightBlocksAndOperationsHaveIds) {
    Diagnostics d;
    std::string blocks;
    for (size_t i = 0; i <= limits::kLightBlocks; ++i) blocks += "solar() Cl = 1;\n";
    auto p = compileText("light l() {\n" + blocks + "}\n", "t.sl", {}, d);
    ASSERT_TRUE(p) << all(d);
    EXPECT_FALSE(buildKernel(*p, *p->shaders[0], {}, d));
    ASSERT_EQ(d.errors(), 1) << all(d);
    EXPECT_EQ(d.all().back().id, "light-blocks") << d.all().back().message;
}

} // namespace shader_attacks_test

// What a shader may cost.
#include "../nightly.h"
#include "../sanitized.h"
#include "base/limits.h"
#include "rsl/compiler.h"
#include "rsl/front/ast.h"
#include "rsl/ir/build.h"
#include "rsl/ir/edit.h"
#include "rsl/jit/cache.h"
#include "rsl/passes/optimize.h"
#include "rsl/printlog.h"
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace shader_limits_test {

namespace fs = std::filesystem;
using namespace alpenglow;
using namespace alpenglow::rsl;

namespace {

struct Folder {
    fs::path path;
    Folder() {
        std::string t = (fs::temp_directory_path() / "alpenglow-limits-XXXXXX").string();
        path = mkdtemp(t.data());
    }
    ~Folder() {
        std::error_code e;
        fs::remove_all(path, e);
    }
    void put(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

std::string repeat(const std::string& s, int n) {
    std::string r;
    for (int i = 0; i < n; ++i) r += s;
    return r;
}

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

/// The optimised kernel of the last shader; null after an error.
std::unique_ptr<ir::Kernel> kernelOf(const std::string& text, const KernelOptions& options = {}) {
    Diagnostics d;
    auto p = compileText(text, "t.sl", {}, d);
    auto k = p ? buildKernel(*p, *p->shaders.back(), options, d) : nullptr;
    if (k) passes::optimize(*k, options, d);
    EXPECT_TRUE(k) << all(d);
    return k;
}

int functionsIn(const ir::Kernel& k) {
    int n = 0;
    ir::forEach(k.body, [&](const ir::Inst* i) { n += i->op == ir::Op::Function; });
    return n;
}

bool says(const std::string& messages, const std::string& part) { return messages.find(part) != std::string::npos; }

} // namespace

TEST(ShaderLimits, ArrayLength) {
    auto declare = [](int n) { return complaint("surface s() { float a[" + std::to_string(n) + "]; a[0] = 1; Ci = a[0]; }"); };
    EXPECT_EQ(declare(limits::kShaderArray), "");
    EXPECT_TRUE(says(declare(limits::kShaderArray + 1), "t.sl:1:"));
    EXPECT_TRUE(says(declare(limits::kShaderArray + 1), "between 1 and"));
    auto list = [](int n) { return complaint("surface s() { float a[1] = { 0" + repeat(", 0", n - 1) + " }; Ci = a[0]; }"); };
    EXPECT_TRUE(says(list(limits::kShaderArray + 1), "at most " + std::to_string(limits::kShaderArray)));
}

TEST(ShaderLimits, IncludeDepth) {
    Folder f;
    for (int i = 1; i <= limits::kIncludeDepth; ++i)
        f.put("d" + std::to_string(i) + ".h",
              i == limits::kIncludeDepth ? "\n" : "#include \"d" + std::to_string(i + 1) + ".h\"\n");
    f.put("self.h", "#include \"self.h\"\n");
    FrontOptions o;
    o.includePaths = {f.path.string()};
    EXPECT_EQ(complaint("#include \"d1.h\"\nsurface s() { Ci = 1; }", o), "");
    const std::string m = complaint("#include \"self.h\"\nsurface s() { Ci = 1; }", o);
    EXPECT_TRUE(says(m, "nested more than " + std::to_string(limits::kIncludeDepth))) << m;
    EXPECT_TRUE(says(m, "self.h:1:")) << m;
}

TEST(ShaderLimits, MacroDepth) {
    auto nested = [](int n) {
        return complaint("#define F(x) x\nsurface s() { Ci = " + repeat("F(", n) + "1" + repeat(")", n) + "; }");
    };
    EXPECT_EQ(nested(limits::kMacroDepth / 2), "");
    EXPECT_TRUE(says(nested(limits::kMacroDepth + 1), "nested more than " + std::to_string(limits::kMacroDepth)));
}

TEST(ShaderLimits, MacroTokens) {
    // A_i stands for 2^i ones and as many signs: A_21 is more than kMacroTokens.
    std::string text = "#define A0 1 +\n";
    for (int i = 1; i <= 21; ++i)
        text += "#define A" + std::to_string(i) + " A" + std::to_string(i - 1) + " A" + std::to_string(i - 1) + "\n";
    static_assert(limits::kMacroTokens < (size_t(2) << 21) && limits::kMacroTokens > (size_t(2) << 8));
    EXPECT_EQ(complaint(text + "surface s() { Ci = A8 1; }"), "");
    EXPECT_TRUE(says(complaint(text + "surface s() { Ci = A21 1; }"), "more than " + std::to_string(limits::kMacroTokens)));
}

TEST(ShaderLimits, InlinedInstructions) {
    // Each function calls the one before twice: f_n makes 2^n random numbers once all is inlined, which random() asks for.
    auto messages = [](int n) {
        std::string text = "float f0(float x) { return random() + x; }\n";
        for (int i = 1; i <= n; ++i) {
            const std::string g = "f" + std::to_string(i - 1);
            text += "float f" + std::to_string(i) + "(float x) { return " + g + "(x) + " + g + "(x + 1); }\n";
        }
        text += "surface s() { Ci = f" + std::to_string(n) + "(v); }\n";
        Diagnostics d;
        auto p = compileText(text, "t.sl", {}, d);
        EXPECT_TRUE(p) << all(d);
        if (!p) return all(d);
        auto k = buildKernel(*p, *p->shaders.back(), {}, d);
        EXPECT_EQ(k == nullptr, d.errors() > 0);
        return all(d);
    };
    static_assert(limits::kInlinedInstructions < size_t(1) << 20);
    EXPECT_EQ(messages(8), "");
    const std::string m = messages(20);
    EXPECT_TRUE(says(m, "too large") && says(m, "[shader-too-large]")) << m;
    EXPECT_TRUE(says(m, "t.sl:")) << m;
}

TEST(ShaderLimits, InlinedInstructionsOfACoShaderNameItsFile) {
    std::string text = "class big() { public float f0(float x) { return random() + x; }\n";
    for (int i = 1; i <= 20; ++i) {
        const std::string g = "f" + std::to_string(i - 1);
        text += "public float f" + std::to_string(i) + "(float x) { return " + g + "(x) + " + g + "(x + 1); }\n";
    }
    text += "}\n";
    Diagnostics d;
    const auto big = compileText(text, "big.sl", {}, d);
    const auto p = compileText("surface s() { shader b = getshader(\"b\"); Ci = b->f20(v); }", "t.sl", {}, d);
    ASSERT_TRUE(big && p) << all(d);
    KernelOptions o;
    CoShader c;
    c.handle = "b";
    c.program = big.get();
    c.shader = big->shaders.back().get();
    o.coShaders.push_back(c);
    EXPECT_EQ(buildKernel(*p, *p->shaders.back(), o, d), nullptr);
    const std::string m = all(d);
    EXPECT_TRUE(says(m, "too large") && says(m, "big.sl:")) << m;
}

TEST(ShaderLimits, OutlinedFunctions) {
    // A function of more operations than kOutlineInstructions stays one when it is called twice; each term has two at least.
    auto functions = [](int terms) {
        std::string text = "float f(float x) { float y = 0;";
        for (int i = 0; i < terms; ++i) text += " y += sin(x * " + std::to_string(i + 2) + ");";
        auto k = kernelOf(text + " return y; }\nsurface s() { Ci = f(u) + f(v); }");
        return k ? functionsIn(*k) : -1;
    };
    EXPECT_EQ(functions(limits::kOutlineInstructions / 20), 0);
    EXPECT_EQ(functions(limits::kOutlineInstructions), 1);
}

TEST(ShaderLimits, InliningForTheAffineProof) {
    // f_n is 2^n additions of what a ray brings. The proof needs it inlined: below kAffineInlining it is, beyond, calls stay and
    // the kernel waits for its ray.
    auto sum = [](int n) {
        std::string text = "color f0(color c; float x) { return c * sin(x); }\n";
        for (int i = 1; i <= n; ++i) {
            const std::string g = "f" + std::to_string(i - 1);
            text += "color f" + std::to_string(i) + "(color c; float x) { return " + g + "(c, x * 2) + " + g + "(c, x + 1); }\n";
        }
        return kernelOf(text + "surface s() { Ci = f" + std::to_string(n) + "(trace(P, N), u); }\n");
    };
    auto small = sum(6);
    ASSERT_TRUE(small);
    EXPECT_TRUE(small->facts.affine);
    if (kSanitized) GTEST_SKIP() << "a kernel of a million operations takes minutes here";
    if (!nightly()) return; // a kernel of a million operations takes half a minute
    auto large = sum(24);
    ASSERT_TRUE(large);
    EXPECT_FALSE(large->facts.affine);
    EXPECT_FALSE(large->facts.whyNot.empty());
    EXPECT_GT(functionsIn(*large), 0);
    EXPECT_LE(ir::instructionCount(large->body), 16 * limits::kAffineInlining); // rounds of inlining are not cut in the middle
}

TEST(ShaderLimits, PrintedText) {
    // Nothing is written while temporary files can take it; when they are used up, what was collected. Void samples leave
    // nothing.
    std::FILE* file = std::tmpfile();
    ASSERT_TRUE(file);
    {
        static_assert(limits::kPrintBytes >= 1 << 20); // the same code with a smaller number
        PrintLog log(file, 1 << 20);
        const std::string text(700u << 10, '.'); // one is a run
        for (size_t i = 0; i <= limits::kPrintRuns; ++i) log.add({.sample = int64_t(i)}, text);
        EXPECT_EQ(std::ftell(file), 0);
        log.discard();
        for (size_t i = 0; i <= limits::kPrintRuns; ++i) log.add({.sample = int64_t(i)}, text);
        EXPECT_EQ(std::ftell(file), 0);
        log.add({.sample = 0}, text);
        EXPECT_EQ(size_t(std::ftell(file)), (limits::kPrintRuns + 1) * text.size());
        log.discard();
    }
    std::fclose(file);
}

TEST(ShaderLimits, KernelsOnDisk) {
    // An old entry as large as the whole cache may be (a hole on disk) goes when there is another one and the cache is trimmed.
    Folder f;
    fs::permissions(f.path, fs::perms::owner_all);
    f.put("old.kernel", "");
    fs::resize_file(f.path / "old.kernel", limits::kKernelCacheBytes);
    fs::last_write_time(f.path / "old.kernel", fs::file_time_type::clock::now() - std::chrono::hours(1));
    ShaderCompiler::Settings s;
    s.cacheDirectory = f.path.string();
    ShaderCompiler compiler(s);
    Diagnostics d;
    auto shader = compiler.loadText("surface s() { Ci = u; Oi = 1; }", "s.sl", d);
    ASSERT_TRUE(shader) << all(d);
    ASSERT_TRUE(compiler.kernel(shader, {}, d)) << all(d);
    rsl::jit::KernelCache(f.path.string(), limits::kKernelCacheBytes).trim(); // stores do so now and then
    EXPECT_FALSE(fs::exists(f.path / "old.kernel"));
    uintmax_t total = 0, files = 0;
    for (const auto& e : fs::directory_iterator(f.path)) total += e.file_size(), ++files;
    EXPECT_GE(files, 1u);
    EXPECT_LE(total, limits::kKernelCacheBytes);
}

} // namespace shader_limits_test

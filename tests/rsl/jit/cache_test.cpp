// The disk cache, the loader and the compiler around them.
#include "handmade.h"
#include "rsl/compiler.h"
#include "rsl/evaluate.h"
#include "rsl/jit/cache.h"
#include "rsl/jit/identity.h"
#include "rsl/jit/loader.h"
#include "rsl/jit/module.h"
#include "rsl/jit/sha256.h"
#include "rsl/jit/stamp.h"
#include "rsl/services_basic.h"
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>
#include <unistd.h>

namespace fs = std::filesystem;

namespace alpenglow::rsl::test::cache_test {
namespace {

struct Directory {
    fs::path path;
    Directory() {
        std::string t = (fs::temp_directory_path() / "alpenglow-test-XXXXXX").string();
        path = mkdtemp(t.data());
    }
    ~Directory() {
        std::error_code e;
        fs::remove_all(path, e);
    }
};

// FIPS 180-4 examples.
TEST(Sha256, Standard) {
    EXPECT_EQ(jit::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(jit::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(jit::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

jit::KernelFile simpleKernel() {
    Made m;
    m.output("y", m.put(Op::Add, Kind::Float, {m.input("x"), m.number(1)}));
    m.site("texture");
    m.k.sites[0].strings = {"a.tx"};
    m.k.sites[0].shadeop = findShadeop("texture");
    m.k.facts.whyNot = "because";
    m.k.facts.direct = {{"specular", "it is squared", {0, 12, 3}}};
    jit::KernelFile f;
    std::string error;
    EXPECT_TRUE(jit::generate(m.k, KernelOptions{}, f, error)) << error;
    f.messages.push_back({Severity::Warning, Rie::Math, {"a.sl", 3, 4}, "message", "hint", "line", "zero-division"});
    return f;
}

TEST(KernelFile, SurvivesPacking) {
    const jit::KernelFile f = simpleKernel();
    auto g = jit::unpack(jit::pack(f));
    ASSERT_TRUE(g);
    EXPECT_EQ(g->object, f.object);
    ASSERT_EQ(g->sites.size(), 1u);
    EXPECT_EQ(g->sites[0].strings, f.sites[0].strings);
    EXPECT_EQ(g->sites[0].shadeop, findShadeop("texture"));
    EXPECT_EQ(g->facts.whyNot, "because");
    ASSERT_EQ(g->facts.direct.size(), 1u);
    EXPECT_EQ(g->facts.direct[0].text(), "specular, line 12: it is squared");
    ASSERT_EQ(g->messages.size(), 1u);
    EXPECT_EQ(g->messages[0].place.column, 4);
    EXPECT_EQ(g->messages[0].id, "zero-division");
    EXPECT_EQ(g->inputs[0].name, "x");
}

// No damage is taken for a kernel: the checksum sees every byte.
TEST(KernelFile, DamageIsSeen) {
    const std::string good = jit::pack(simpleKernel());
    std::mt19937 random(1);
    for (int k = 0; k < 300; k++) {
        std::string bad = good;
        if (k % 3 == 0) bad.resize(random() % bad.size());
        else bad[random() % bad.size()] ^= char(1 << random() % 8);
        EXPECT_FALSE(jit::unpack(bad));
    }
}

// Nor does the loader crash on damaged objects (they are loaded, never run).
TEST(Loader, DamagedObjects) {
    const std::string good = simpleKernel().object;
    std::string error;
    ASSERT_TRUE(jit::LoadedObject::load(good, error)) << error;
    std::mt19937 random(2);
    int refused = 0;
    for (int k = 0; k < 3000; k++) {
        std::string bad = good;
        if (k % 4 == 0) bad.resize(random() % bad.size());
        else
            for (int n = 0; n < 1 + k % 5; n++) bad[random() % bad.size()] = char(random());
        refused += jit::LoadedObject::load(bad, error) == nullptr;
    }
    EXPECT_GT(refused, 500);
}

TEST(Cache, StoresLoadsTrims) {
    Directory d;
    const jit::KernelFile f = simpleKernel();
    const size_t size = jit::pack(f).size();
    jit::KernelCache cache((d.path / "c").string(), size * 3 + size / 2);
    EXPECT_FALSE(cache.load("absent"));
    for (int k = 0; k < 5; k++) {
        cache.store("key" + std::to_string(k), f);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        if (k >= 1) {
            EXPECT_TRUE(cache.load("key0")) << k; // used again and again: stays
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_TRUE(cache.load("key0"));
    EXPECT_TRUE(cache.load("key4"));
    EXPECT_FALSE(cache.load("key1"));
    EXPECT_EQ(fs::status(d.path / "c").permissions() & fs::perms::all, fs::perms::owner_all);
    // Damage is a miss, and the file goes.
    const fs::path file = d.path / "c" / "key4.kernel";
    std::fstream(file, std::ios::in | std::ios::out | std::ios::binary).seekp(200).write("xxxx", 4);
    EXPECT_FALSE(cache.load("key4"));
    EXPECT_FALSE(fs::exists(file));
    // Code that others can write is not run.
    fs::permissions(d.path / "c", fs::perms::all);
    EXPECT_FALSE(cache.load("key0"));
}

TEST(Cache, AnotherKernelsFileIsNotTaken) {
    Directory d;
    jit::KernelCache cache((d.path / "c").string(), size_t(1) << 30);
    jit::KernelFile one = simpleKernel(), two = one;
    two.facts.whyNot = "two";
    cache.store("one", one);
    cache.store("two", two);
    const fs::path a = d.path / "c" / "one.kernel", b = d.path / "c" / "two.kernel";
    fs::rename(a, d.path / "t");
    fs::rename(b, a);
    fs::rename(d.path / "t", b);
    EXPECT_FALSE(cache.load("one")); // its digest is right, its key is not
    EXPECT_FALSE(cache.load("two"));
    EXPECT_FALSE(fs::exists(a));
    cache.store("one", one);
    ASSERT_TRUE(cache.load("one"));
    EXPECT_EQ(cache.load("one")->facts.whyNot, "because");
    // Nor a file that others can write, nor a link.
    fs::permissions(a, fs::perms::owner_all | fs::perms::group_write);
    EXPECT_FALSE(cache.load("one"));
    cache.store("two", two);
    fs::remove(a);
    fs::create_symlink(b, a);
    EXPECT_FALSE(cache.load("one"));
}

TEST(Cache, FolderThatOthersCanWriteIsNamedOnce) {
    Directory d;
    const fs::path folder = d.path / "c";
    fs::create_directory(folder);
    fs::permissions(folder, fs::perms::owner_all | fs::perms::group_all);
    ShaderCompiler::Settings settings;
    settings.cacheDirectory = folder.string();
    ShaderCompiler compiler(settings);
    Diagnostics diagnostics;
    for (const char* text : {"surface a() { Ci = u; }", "surface b() { Ci = v; }"}) {
        auto shader = compiler.loadText(text, "t.sl", diagnostics);
        ASSERT_TRUE(shader);
        EXPECT_TRUE(compiler.kernel(shader, KernelOptions{}, diagnostics));
    }
    ASSERT_EQ(diagnostics.all().size(), 1u);
    EXPECT_NE(diagnostics.all()[0].message.find("others can write to it"), std::string::npos) << diagnostics.all()[0].message;
    EXPECT_TRUE(fs::is_empty(folder)); // what is never read is not written
}

TEST(Cache, TemporariesOfKilledProgramsGo) {
    Directory d;
    jit::KernelCache cache(d.path.string(), size_t(1) << 30);
    for (const char* name : {"old.kernel.1.0.tmp", "new.kernel.1.0.tmp"}) std::ofstream(d.path / name) << "x";
    fs::last_write_time(d.path / "old.kernel.1.0.tmp", fs::file_time_type::clock::now() - std::chrono::hours(25));
    cache.trim();
    EXPECT_FALSE(fs::exists(d.path / "old.kernel.1.0.tmp"));
    EXPECT_TRUE(fs::exists(d.path / "new.kernel.1.0.tmp"));
}

// What looks at the whole folder is not done for each kernel, but often enough that the folder stays as small as it may be.
TEST(Cache, IsTrimmedNowAndThen) {
    Directory d;
    const jit::KernelFile f = simpleKernel();
    const size_t size = jit::pack(f).size(), most = 640 * size; // a 64th of it: ten kernels
    const auto looks = [&](const std::string& key, size_t count) {
        jit::KernelCache cache(d.path.string(), most);
        const fs::path old = d.path / "old.kernel.1.0.tmp"; // a look takes it away
        int n = 0;
        for (size_t i = 0; i < count; ++i) {
            std::ofstream(old) << "x";
            fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(25));
            cache.store(key + std::to_string(i), f);
            n += !fs::exists(old);
        }
        return n;
    };
    EXPECT_EQ(looks("ab", 8), 0);
    EXPECT_EQ(looks("00ab", 8), 8) << "one key in 256";
    EXPECT_EQ(looks("ab", 44), 4) << "a 64th of the largest size";
}

TEST(Module, BuildIdsAreInTheKey) {
    const std::string file = jit::moduleFile();
    ASSERT_FALSE(file.empty());
    const std::string module = jit::buildIdOfFile(file), program = jit::buildIdOfFile("/proc/self/exe");
    EXPECT_EQ(module.size(), 40u);
    EXPECT_EQ(program.size(), 40u);
    EXPECT_EQ(jit::programIdentity(), program + "+" + module);
    EXPECT_EQ(jit::buildIdOfFile("/dev/null"), "");
}

// A module from other sources is refused with what to do; it is never run.
TEST(ModuleDeathTest, OfAnotherBuild) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    Directory d;
    std::ifstream in(jit::moduleFile(), std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(in), {}};
    const size_t at = bytes.find(jit::kModuleStamp);
    ASSERT_NE(at, std::string::npos);
    bytes[at] = bytes[at] == '0' ? '1' : '0';
    const std::string copy = (d.path / "libalpenglow_jit.so").string();
    std::ofstream(copy, std::ios::binary) << bytes;
    EXPECT_EXIT(
        {
            setenv("ALPENGLOW_JIT", copy.c_str(), 1);
            Made m;
            m.output("y", m.number(1));
            jit::KernelFile f;
            std::string error;
            const bool made = jit::generate(m.k, KernelOptions{}, f, error);
            std::fprintf(stderr, "%s\n", error.c_str());
            std::_Exit(made ? 1 : 0);
        },
        ::testing::ExitedWithCode(0), "built from other sources than this program; build and install both together");
}

TEST(Compiler, ThrowsPassThroughTheLoader) {
    // Whoever asks next gets an answer, not a broken promise.
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics throws([](const Diagnostic&) { throw std::bad_alloc(); });
    EXPECT_THROW(compiler.load("nosuch", {"/nowhere"}, throws), std::bad_alloc);
    Diagnostics diagnostics;
    EXPECT_FALSE(compiler.load("nosuch", {"/nowhere"}, diagnostics));
    EXPECT_EQ(diagnostics.errors(), 1);
}

constexpr const char* kShader = "surface s(float Kd = 0.5; color c = color(1, 2, 3); string name = \"n\"; float a[3] = {1, 2, "
                                "3}; point p = point \"shader\" (1, 2, 3);)"
                                "{ Ci = Kd * c * u * a[1] + xcomp(p); Oi = 1; }";

TEST(Compiler, DiskThenMemory) {
    Directory d;
    ShaderCompiler::Settings settings;
    settings.cacheDirectory = (d.path / "c").string();
    Diagnostics diagnostics;
    for (int run = 0; run < 2; run++) {
        ShaderCompiler compiler(settings);
        auto shader = compiler.loadText(kShader, "s", diagnostics);
        ASSERT_TRUE(shader);
        auto k = compiler.kernel(shader, KernelOptions{}, diagnostics);
        ASSERT_TRUE(k);
        EXPECT_EQ(k->fromCache(), run == 1);
        EXPECT_EQ(compiler.kernel(shader, KernelOptions{}, diagnostics), k);
        EXPECT_EQ(compiler.statistics().compiled, run == 0 ? 1 : 0);
        EXPECT_EQ(compiler.statistics().fromDisk, run == 1 ? 1 : 0);
        EXPECT_EQ(compiler.statistics().fromMemory, 1);
        KernelOptions other;
        other.lanes = 8;
        EXPECT_NE(compiler.kernel(shader, other, diagnostics), k);
    }
    EXPECT_EQ(diagnostics.errors(), 0);
}

TEST(Compiler, ManyThreadsCompileOnce) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics diagnostics;
    auto shader = compiler.loadText(kShader, "s", diagnostics);
    ASSERT_TRUE(shader);
    std::vector<std::shared_ptr<const CompiledKernel>> got(8);
    std::vector<std::thread> threads;
    for (auto& g : got) threads.emplace_back([&] { g = compiler.kernel(shader, KernelOptions{}, diagnostics); });
    for (auto& t : threads) t.join();
    for (const auto& g : got) EXPECT_EQ(g, got[0]);
    ASSERT_TRUE(got[0]);
    EXPECT_EQ(compiler.statistics().compiled, 1);
}

TEST(Compiler, Defaults) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics diagnostics;
    auto shader = compiler.loadText(kShader, "s", diagnostics);
    ASSERT_TRUE(shader);
    auto values = compiler.parameterValues(shader, diagnostics, [](const std::string& from, const std::string&, float m[16]) {
        if (from == "shader") m[12] = 10; // a translation along x, row vectors
        return true;
    });
    ASSERT_EQ(values.size(), 5u);
    EXPECT_EQ(values[0].numbers, std::vector<float>{0.5f});
    EXPECT_EQ(values[1].numbers, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(values[2].strings, std::vector<std::string>{"n"});
    EXPECT_EQ(values[3].numbers, (std::vector<float>{1, 2, 3}));
    EXPECT_EQ(values[4].numbers, (std::vector<float>{11, 2, 3}));
}

TEST(Compiler, MissingShaders) {
    Directory d;
    std::ofstream(d.path / "old.slo") << "binary";
    std::ofstream(d.path / "new.sl") << "surface other() {} surface new() { Ci = 1; }";
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics diagnostics;
    const std::vector<std::string> path{d.path.string()};
    EXPECT_FALSE(compiler.load("old", path, diagnostics));
    EXPECT_FALSE(compiler.load("old", path, diagnostics)); // said once
    ASSERT_EQ(diagnostics.errors(), 1);
    EXPECT_NE(diagnostics.all()[0].message.find("old.sl"), std::string::npos);
    EXPECT_FALSE(compiler.load("none", path, diagnostics));
    EXPECT_EQ(diagnostics.errors(), 2);
    auto s = compiler.load("new", path, diagnostics);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->name(), "new");
}

// The straight patterns hold no call, no memory traffic but their inputs and outputs.
TEST(Compiler, PatternsAreStraightCode) {
    const fs::path bench = fs::path(ALPENGLOW_SOURCE_DIR) / "../shared/bench";
    if (!fs::exists(bench)) GTEST_SKIP() << "no ../shared/bench";
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics diagnostics;
    for (const char* name : {"base", "a_fbm", "b_marble", "c_worley", "d_brick", "e_math", "f_mandel", "g_fbm_deriv"}) {
        SCOPED_TRACE(name);
        auto shader = compiler.load(name, {bench.string()}, diagnostics);
        ASSERT_TRUE(shader);
        const std::string all = compiler.dump(shader, KernelOptions{}, diagnostics, true);
        const std::string llvm = all.substr(all.find("; ModuleID"));
        for (const char* bad : {"alloca", "masked.gather", "masked.scatter", "memset", "memcpy"})
            EXPECT_EQ(llvm.find(bad), std::string::npos) << bad;
        std::istringstream lines(llvm);
        for (std::string line; std::getline(lines, line);)
            if (line.find(" call ") != std::string::npos) { EXPECT_NE(line.find("@llvm."), std::string::npos) << line; }
    }
}

// 3Delight manual, 6.4.7, format().
TEST(Services, Format) {
    const FormatValue f{Base::Float, {1.5f}, {}}, s{Base::String, {}, "rose"}, p{Base::Point, {1, 2, 3}, {}};
    FormatValue m{Base::Matrix, {}, {}};
    for (int k = 0; k < 4; k++) m.numbers[5 * k] = 1;
    EXPECT_EQ(formatText("%f %e %g %d", {f, f, f, f}), "1.500000 1.500000e+00 1.5 2");
    EXPECT_EQ(formatText("%.2f|%8.2f|%-8.2f|%08.2f|%+.1f", {f, f, f, f, f}), "1.50|    1.50|1.50    |00001.50|+1.5");
    EXPECT_EQ(formatText("%.3g", {f}), "1.500");
    EXPECT_EQ(formatText("p = %.5p", {p}), "p = [1.00000 2.00000 3.00000]");
    EXPECT_EQ(formatText("%m", {m}), "[1 0 0 0, 0 1 0 0, 0 0 1 0, 0 0 0 1]");
    EXPECT_EQ(formatText("%.1m", {m}), "[1.0 0.0 0.0 0.0, 0.0 1.0 0.0 0.0, 0.0 0.0 1.0 0.0, 0.0 0.0 0.0 1.0]");
    EXPECT_EQ(formatText("%20s|%.2s|%%", {s, s}), "                rose|ro|%");
    EXPECT_EQ(formatText("%s %f %q %", {s}), "rose %f %q %");
    EXPECT_LE(formatText("%999999999f", {f}).size(), 1000u);
}

TEST(Services, MatchAndHash) {
    EXPECT_TRUE(matchText("a+b", "xxaab"));
    EXPECT_FALSE(matchText("^a+b", "xxaab"));
    std::string error;
    for (int again = 0; again < 2; ++again) { // the last answer is kept, errors and other texts are not it
        EXPECT_FALSE(matchText("(", "x", &error));
        EXPECT_FALSE(error.empty());
        error.clear();
        EXPECT_TRUE(matchText("^x", "xa"));
        EXPECT_FALSE(matchText("^x", "ax"));
        EXPECT_TRUE(matchText("a$", "xa"));
        EXPECT_TRUE(matchText("", ""));
    }
    float a[3], b[3];
    hashText("one", a);
    hashText("two", b);
    for (float x : {a[0], a[1], a[2]}) {
        EXPECT_GE(x, 0.0f);
        EXPECT_LT(x, 1.0f);
    }
    EXPECT_NE(a[0], b[0]);
    EXPECT_NE(a[0], a[1]);
}

TEST(Evaluate, ValuesAndErrors) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    auto text = [&](const char* e, const char* setup = "") { return evaluate(compiler, setup, e, KernelOptions{}, d).text; };
    EXPECT_EQ(text("radians(180)"), "3.141593");
    EXPECT_EQ(text("color(u, v, 1)"), "0.5 0.5 1");
    EXPECT_EQ(text("P + N"), "0 0 1");
    EXPECT_EQ(text("concat(\"a\", \"b\")"), "ab");
    EXPECT_EQ(text("x * 2", "float x = 4;"), "8");
    EXPECT_EQ(text("matrix 2"), "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 2");
    EXPECT_EQ(d.errors(), 0);
    EXPECT_EQ(evaluate(compiler, "", "printf(\"%d\\n\", 3)", KernelOptions{}, d).printed, "3\n");
    EXPECT_FALSE(evaluate(compiler, "", "nosuch + 1", KernelOptions{}, d).ok);
    EXPECT_EQ(d.errors(), 1);
}

} // namespace
} // namespace alpenglow::rsl::test::cache_test

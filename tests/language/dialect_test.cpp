// Whole shaders in the manner of the last thirty years' published ones (dialects/*.sl): each must become machine code without an
// error, and with exactly the warnings that a comment "warns: ids" on its first line names. What single constructs mean is in
// dialect_*.rsl.
#include "rsl/compiler.h"
#include "rsl/front/headers.h"
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace alpenglow::rsl::dialect_test {
namespace {

std::vector<std::string> shaders() {
    std::vector<std::string> all;
    for (const auto& f : fs::directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language/dialects"))
        if (f.path().extension() == ".sl") all.push_back(f.path().stem().string());
    std::sort(all.begin(), all.end());
    return all;
}

std::string messages(const Diagnostics& d) {
    std::string s;
    for (const auto& m : d.all()) s += std::to_string(m.place.line) + ": " + m.message + "\n";
    return s;
}

class Dialects : public ::testing::TestWithParam<std::string> {};

TEST_P(Dialects, CompilesQuietly) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    Diagnostics d;
    const auto shader = compiler.load(GetParam(), {ALPENGLOW_SOURCE_DIR "/tests/language/dialects"}, d);
    ASSERT_TRUE(shader) << messages(d);
    for (bool path : {false, true}) {
        KernelOptions options;
        options.path = path;
        EXPECT_TRUE(compiler.kernel(shader, options, d)) << messages(d);
    }
    std::multiset<std::string> expected, said;
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/tests/language/dialects/" + GetParam() + ".sl");
    std::string first;
    std::getline(in, first);
    if (const size_t at = first.find("warns: "); at != std::string::npos) {
        std::istringstream words(first.substr(at + 7));
        for (std::string w; words >> w && w != "*/";) expected.insert(w);
    }
    for (const Diagnostic& m : d.all())
        if (m.id != "not-available") said.insert(m.id); // a shadeop that waits for its part of the renderer says so once
    EXPECT_EQ(said, expected) << messages(d);
}

INSTANTIATE_TEST_SUITE_P(Files, Dialects, ::testing::ValuesIn(shaders()), [](const auto& i) { return i.param; });

TEST(DialectHeaders, EachCompilesAlone) {
    ASSERT_GE(front::shippedHeaders().size(), 14u);
    for (const auto& h : front::shippedHeaders()) {
        Diagnostics d;
        const std::string text = "#include \"" + std::string(h.name) + "\"\nsurface s() { Ci = 1; }\n";
        EXPECT_TRUE(compileText(text, "s", {}, d)) << h.name << "\n" << messages(d);
        EXPECT_EQ(d.all().size(), 0u) << h.name << "\n" << messages(d);
    }
}

TEST(DialectHeaders, AFileOfThatNameComesFirst) {
    const fs::path folder = fs::path(::testing::TempDir()) / "alpenglow_dialect_headers";
    fs::create_directories(folder);
    std::ofstream(folder / "noises.h") << "#define mine 3\n";
    FrontOptions options;
    options.includePaths = {folder.string()};
    Diagnostics d;
    EXPECT_TRUE(compileText("#include \"noises.h\"\nsurface s() { Ci = mine; }\n", "s", options, d)) << messages(d);
    fs::remove_all(folder);
}

TEST(DialectMacros, EachHasItsOwnAndOurs) {
    const std::pair<const char*, const char*> kMacros[] = {{"", "DELIGHT"},    {"3delight", "DELIGHT"}, {"prman", "PRMAN"},
                                                           {"aqsis", "AQSIS"}, {"bmrt", "BMRT"},        {"PRMan", "PRMAN"},
                                                           {"rispec", "none"}};
    for (const auto& [dialect, macro] : kMacros)
        for (const char* other : {"DELIGHT", "PRMAN", "AQSIS", "BMRT"}) {
            FrontOptions options;
            options.dialect = dialect;
            Diagnostics d;
            const bool same = std::string(macro) == other;
            const std::string text = std::string("#if !defined(ALPENGLOW) || ") + (same ? "!" : "") + "defined(" + other +
                                     ")\n#error wrong\n#endif\nsurface s() { Ci = 1; }\n";
            EXPECT_TRUE(compileText(text, "s", options, d)) << dialect << " " << other << "\n" << messages(d);
        }
}

} // namespace
} // namespace alpenglow::rsl::dialect_test

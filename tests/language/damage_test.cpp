// Damaged programs: words of the snippet programs left out, doubled, exchanged and replaced. Whatever comes out, the compiler
// says either yes or why not; it never falls over, and the IR of what it accepts is sound.
#include "rsl/compiler.h"
#include "rsl/ir/build.h"
#include "rsl/ir/verify.h"
#include "snippets.h"
#include <algorithm>
#include <cctype>
#include <gtest/gtest.h>
#include <random>

namespace fs = std::filesystem;

namespace alpenglow::rsl::damage_test {
namespace {

std::vector<std::string> words(const std::string& text) {
    std::vector<std::string> out;
    for (size_t i = 0; i < text.size();) {
        size_t end = i + 1;
        const auto word = [&](size_t k) {
            return std::isalnum(static_cast<unsigned char>(text[k])) || text[k] == '_' || text[k] == '.';
        };
        if (word(i))
            while (end < text.size() && word(end)) end++;
        else if (text[i] == '"') end = std::min(text.size(), std::min(text.find('"', i + 1), text.size() - 1) + 1);
        out.push_back(text.substr(i, end - i));
        i = end;
    }
    return out;
}

TEST(Damage, EveryProgramIsAcceptedOrExplained) {
    std::vector<std::string> sources;
    std::vector<fs::path> files;
    const fs::path root = fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language";
    for (const auto& e : fs::directory_iterator(root))
        if (e.path().extension() == ".rsl") files.push_back(e.path());
    std::sort(files.begin(), files.end());
    for (const fs::path& f : files) {
        const Snippets s = parseSnippets(f);
        for (const WholeProgram& p : s.programs) sources.push_back(trim(p.source));
        for (const Expectation& e : s.expectations)
            if (!e.prints)
                sources.push_back("surface s()\n{\n" + e.setup + "color result = " + e.expression + ";\nCi = result;\n}\n");
    }
    ASSERT_GT(sources.size(), 500u);
    static const char* const strange[] = {
        "(",     ")",      "{",       "}",           ";",      ",",       "=",     "[",  "]",    "\"",    "output",  "float",
        "color", "return", "break 3", "illuminance", "extern", "uniform", "1e999", "if", "else", "while", "surface", "->",
        "#",     "##",     "\\",      "struct",      "matrix", "+",       "0",     "P",  "\xff", "for",   "void",    "string"};
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    std::mt19937 rng(20240607);
    const auto pick = [&](size_t n) { return size_t(rng() % n); };
    int accepted = 0, refused = 0;
    for (int turn = 0; turn < 20000; turn++) {
        std::vector<std::string> w = words(sources[pick(sources.size())]);
        if (w.empty()) continue;
        for (size_t n = 1 + pick(3); n > 0; n--) {
            const size_t at = pick(w.size());
            switch (pick(5)) {
            case 0:
                w[at].clear();
                break;
            case 1:
                w.insert(w.begin() + long(at), w[at]);
                break;
            case 2:
                std::swap(w[at], w[pick(w.size())]);
                break;
            case 3:
                w[at] = strange[pick(std::size(strange))];
                break;
            default:
                w.resize(std::max<size_t>(1, at));
                break;
            }
            if (w.size() < 2) break;
        }
        std::string text;
        for (const std::string& x : w) text += x;
        SCOPED_TRACE(text);
        Diagnostics d;
        const auto shader = compiler.loadText(text, "damaged", d);
        if (!shader) {
            refused++;
            const auto all = d.all();
            ASSERT_TRUE(std::any_of(all.begin(), all.end(), [](const Diagnostic& m) {
                return m.severity >= Severity::Error && m.place.line > 0;
            })) << "refused without a reason at a place";
            continue;
        }
        accepted++;
        KernelOptions o;
        const auto kernel = buildKernel(shader->program(), shader->shader(), o, d);
        ASSERT_TRUE(kernel || !d.all().empty());
        if (kernel) ASSERT_EQ(ir::verify(*kernel), "");
        o.path = turn % 2 == 1;
        if (const auto optimised = kernel ? compiler.analyse(*shader, o, d) : nullptr) ASSERT_EQ(ir::verify(*optimised), "");
    }
    EXPECT_GT(accepted, 1000);
    EXPECT_GT(refused, 5000);
}

} // namespace
} // namespace alpenglow::rsl::damage_test

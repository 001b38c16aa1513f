// Random programs: machine code against the walker, at every width, in both builds, optimised and not, functions inlined and
// called. A difference is made as small as RapidCheck can make it before it is shown.
#include "../sanitized.h"
#include "points.h"
#include "programs.h"
#include "snippets.h"
#include "walker.h"
#include <chrono>
#include <cstdlib>
#include <gtest/gtest.h>
#include <set>
#include <sstream>
#include <stdexcept>

namespace alpenglow::rsl::walker_test {
namespace {

constexpr int kBatch = 10, kPoints = 21, kMostShrinks = 3000;
constexpr int kParts = 4; ///< one test each, so that they run side by side

/// Which random programs: those that are kept, unless another set is asked for. Printed with what goes wrong.
uint64_t firstProgram() {
    const char* given = std::getenv("ALPENGLOW_SEED");
    return given ? std::strtoull(given, nullptr, 10) * 1000003 : 0;
}

/// Programs in all the parts together. Nearly all the time goes into machine code for them, so those of every day are shorter.
int wanted(bool night) { return night ? 10000 : 180; }
int wanted() { return kSanitized ? 80 : wanted(nightly()); }

float input(const std::string& name, int component, int point) {
    float v = 0;
    EvaluationPoint::value(name, component, 0, v);
    const float a = float((point * 17 + 5) % kPoints) / kPoints, b = float((point * 13 + 1) % kPoints) / kPoints;
    if (name == "u" || (name == "P" && component == 0)) return a;
    if (name == "v" || (name == "P" && component == 1)) return b;
    return v;
}

bool alike(float a, float b) { return sameBits(a, b) || (a == 0 && b == 0); }

using Results = std::vector<std::map<std::string, Walked>>; ///< by point

WalkedLights testLights() {
    WalkedLights l;
    for (const float(&row)[9] : kTestLights) std::copy_n(row, 9, l.all.emplace_back().begin());
    l.lit = litBy;
    return l;
}

struct Machine {
    ShaderCompiler compiler{[] {
        ShaderCompiler::Settings s;
        s.useDefaultCache = false;
        return s;
    }()};

    /// What is wrong with these programs under these options; "" when nothing is.
    std::string compare(const std::vector<Term>& programs, const std::vector<KernelOptions>& all, bool object, bool& compiles) {
        Diagnostics d;
        const auto shader = compiler.loadText(shaderOf(programs, object), "random", d);
        compiles = shader != nullptr;
        if (!shader) return firstError(d);
        Results expected;
        try {
            for (int p = 0; p < kPoints; p++)
                expected.push_back(
                    walk(shader->shader(), [&](const std::string& name, int c) { return input(name, c, p); }, testLights()));
        } catch (const std::runtime_error& e) { // no program: what asks for a light was torn out of its loop
            compiles = false;
            return e.what();
        }
        const auto defaults = compiler.parameterValues(shader, d);
        for (KernelOptions o : all) {
            for (size_t n = 0; n < programs.size(); n++)
                for (const auto& [name, type] : outputs(int(n))) o.outputs.push_back(name);
            const auto kernel = compiler.kernel(shader, o, d);
            if (!kernel) return describe(o) + ": no kernel: " + firstError(d);
            std::vector<std::vector<float>> got;
            const auto at = [](const std::string& name, int component, int part, int point) {
                return part == 0 ? input(name, component, point) : 0.0f;
            };
            if (!runPoints(*kernel, o.mixed, kPoints, at, defaults, got, d)) return describe(o) + ": it suspends";
            for (size_t k = 0; k < got.size(); k++)
                for (size_t x = 0; x < got[k].size(); x++)
                    if (const std::string s = difference(kernel->outputs()[k], got[k][x], x / kPoints, expected[x % kPoints]);
                        !s.empty())
                        return describe(o) + ", point " + std::to_string(x % kPoints) + ": " + s;
        }
        return {};
    }

    static std::string firstError(const Diagnostics& d) {
        for (const Diagnostic& m : d.all())
            if (m.severity >= Severity::Error) return toString(m);
        return "without an error";
    }

    static std::string difference(const ir::OutputSlot& o, float got, size_t c, const std::map<std::string, Walked>& expected) {
        const Walked& w = expected.at(o.name);
        if (o.kind == ir::Kind::String) {
            const std::string& text = internedString(std::bit_cast<int32_t>(got));
            return text == w.s ? "" : o.name + " is \"" + text + "\", not \"" + w.s + "\"";
        }
        if (alike(got, w.n[c])) return {};
        return o.name + "[" + std::to_string(c) + "] is " + formatNumbers({got}) + ", not " + formatNumbers({w.n[c]});
    }

    /// The smallest program that still differs, as text with what is wrong.
    std::string smallest(rc::Shrinkable<Term> program, const std::vector<KernelOptions>& all, bool object) {
        bool compiles = true;
        std::string wrong = compare({program.value()}, all, object, compiles);
        if (wrong.empty()) return "only in company of the others of its batch";
        int left = kMostShrinks;
        for (bool found = true; found && left > 0;) {
            found = false;
            for (auto s = program.shrinks(); !found && left-- > 0;) {
                auto next = s.next();
                if (!next) break;
                const std::string w = compare({next->value()}, all, object, compiles);
                if (!compiles || w.empty()) continue; // a part torn out of its loop is no program
                program = *next;
                wrong = w;
                found = true;
            }
        }
        return wrong + "\n" + shaderOf({program.value()}, object);
    }
};

/// What a batch is run in: two configurations, and as a shader or as a class.
struct Turn {
    std::vector<KernelOptions> configurations;
    bool object = false;
};

/// All take their turns in first place, and at night every pair of them comes. Code that is not optimised costs half: every day
/// it is the second.
Turn turnOf(int batch, bool night) {
    const std::vector<KernelOptions> all = allConfigurations();
    const size_t n = all.size(), b = size_t(batch);
    Turn t;
    t.object = batch / kParts % 2 == 1;
    t.configurations.push_back(all[b % n]);
    std::vector<KernelOptions> others;
    for (size_t k = 1; k < n; k++)
        if (night || all[(b + k) % n].optimize == 0) others.push_back(all[(b + k) % n]);
    t.configurations.push_back(others[b / n % others.size()]);
    return t;
}

// Every width, build and level has its turn every day; at night with shaders and with classes, and every two have the same
// program.
TEST(RandomTurns, EveryConfigurationHasItsTurn) {
    const size_t all = allConfigurations().size();
    for (const bool night : {false, true}) {
        std::set<std::string> met, kinds, pairs;
        for (int batch = 0; batch < wanted(night) / kBatch; batch++) {
            const Turn t = turnOf(batch, night);
            ASSERT_EQ(t.configurations.size(), 2u);
            const std::string a = describe(t.configurations[0]), b = describe(t.configurations[1]);
            EXPECT_NE(a, b);
            met.insert(a);
            kinds.insert(a + (t.object ? " class" : " shader"));
            pairs.insert(a + " | " + b);
        }
        EXPECT_EQ(met.size(), all);
        if (night) {
            EXPECT_EQ(kinds.size(), 2 * all);
            EXPECT_EQ(pairs.size(), all * (all - 1));
        }
    }
}

class RandomTrees : public testing::TestWithParam<int> {};

TEST_P(RandomTrees, MachineCodeAndWalkerAgree) {
    Machine machine;
    const rc::Gen<Term> generator = programs();
    const uint64_t first = firstProgram();
    const char* const given = std::getenv("ALPENGLOW_SEED");
    SCOPED_TRACE("ALPENGLOW_SEED=" + std::string(given ? given : "0"));
    const int batches = wanted() / kBatch;
    int compared = 0;
    for (int batch = GetParam(); batch < batches; batch += kParts) {
        std::vector<rc::Shrinkable<Term>> trees;
        std::vector<Term> terms;
        for (int n = 0; n < kBatch; n++) {
            trees.push_back(generator(rc::Random(first + uint64_t(batch * kBatch + n + 1)), nightly() ? 100 : 50));
            terms.push_back(trees.back().value());
        }
        const auto [some, object] = turnOf(batch, nightly());
        bool compiles = true;
        const std::string wrong = machine.compare(terms, some, object, compiles);
        compared += kBatch;
        if (wrong.empty()) continue;
        if (!compiles) {
            ADD_FAILURE() << "batch " << batch << " does not compile: " << wrong;
            continue;
        }
        for (size_t n = 0; n < trees.size(); n++)
            if (!machine.compare({terms[n]}, some, object, compiles).empty())
                ADD_FAILURE() << "program " << batch * kBatch + int(n) + 1 << ": " << machine.smallest(trees[n], some, object);
        EXPECT_EQ(wrong, "") << "batch " << batch;
        if (testing::Test::HasFailure()) break;
    }
    EXPECT_GE(compared, wanted() / kParts - kBatch);
}

/// What an expectation of a snippet file gives: "" when it is right, "?" when the walker does not know something in it.
std::string walkSnippet(ShaderCompiler& compiler, const Expectation& e) {
    for (const char* type : {"float", "color", "point", "vector", "normal", "matrix", "string"}) {
        if (!e.type.empty() && e.type != type) continue;
        Diagnostics quiet;
        const bool text = std::string(type) == "string";
        const auto shader =
            compiler.loadText(std::string("surface s(output varying ") + type + " walked = " + (text ? "\"\"" : "0") + ";) { " +
                                  e.setup + "\n walked = (" + e.expression + "); }\n",
                              "snippet", quiet);
        if (!shader) continue;
        Walked w;
        try {
            w = walk(
                    shader->shader(),
                    [](const std::string& name, int component) {
                        float v = 0;
                        EvaluationPoint::value(name, component, 0, v);
                        return v;
                    },
                    testLights())
                    .at("walked");
        } catch (const std::runtime_error&) { return "?"; }
        if (text) return w.s == e.value ? "" : "\"" + w.s + "\"";
        std::istringstream in(e.value);
        std::vector<std::string> words;
        for (std::string x; in >> x;) words.push_back(x);
        const size_t n = size_t(componentCount(w.base));
        if (words.size() == 1) words.resize(n, words[0]);
        bool right = words.size() == n;
        for (size_t c = 0; right && c < n; c++) {
            std::string shown = formatNumbers({w.n[c]});
            if (shown == "-0" && words[c] == "0") shown = "0";
            right = e.tolerance >= 0 ? std::fabs(double(w.n[c]) - std::atof(words[c].c_str())) <= e.tolerance : shown == words[c];
        }
        return right ? "" : formatNumbers({w.n.begin(), w.n.begin() + long(n)});
    }
    return "?";
}

// The walker itself, against the values that the snippet files say.
TEST(Walker, SnippetsHaveTheirValues) {
    Machine machine;
    int right = 0;
    for (const auto& entry : std::filesystem::directory_iterator(ALPENGLOW_SOURCE_DIR "/tests/language")) {
        if (entry.path().extension() != ".rsl") continue;
        for (const Expectation& e : parseSnippets(entry.path()).expectations) {
            if (e.prints) continue;
            const std::string got = walkSnippet(machine.compiler, e);
            if (got == "?") continue;
            EXPECT_EQ(got, "") << entry.path().filename() << ":" << e.line << " " << e.expression << " => " << e.value;
            right += got.empty();
        }
    }
    EXPECT_GE(right, 400);
    RecordProperty("right", right);
}

INSTANTIATE_TEST_SUITE_P(Parts, RandomTrees, testing::Range(0, kParts));

} // namespace
} // namespace alpenglow::rsl::walker_test

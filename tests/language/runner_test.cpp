// Reads every snippet file (*.rsl) below tests/language and proves what it says. A file holds
//   // setup: STATEMENTS            before every following expression of the file (several lines add up), until
//   // reset
//   // expect: EXPR => VALUE        the value as %.7g numbers separated by spaces (or one number for all components), or the text
//   // expect: EXPR => VALUE ~ 1e-6 within an absolute tolerance
//   // expect string: EXPR => TEXT  for strings; also "expect color:", "expect point:" ... to choose the type of the result
//   // prints: STATEMENT => TEXT    the statement prints exactly TEXT (\n for a line end)
// and whole shaders, each begun by
//   // program: NAME                (not needed for the first) whose text follows, and about it
//   // gives: OUTPUT => VALUE       the shader's output at the point, parameters at their defaults
//   // error LINE:COLUMN: TEXT      each such error must be reported, and no other; LINE counts in the snippet file
//   // warning LINE:COLUMN: TEXT
// All expressions of a file go into one shader with one output each, which runs at 4, 8 and 16 lanes, with uniform inputs as
// numbers (S) and in lanes (V), at O0 and O2, functions inlined and called (configurations() of points.h): the bits must be the
// same everywhere. Nightly each file runs in all of them, else in three, which take turns from file to file. Because the passes
// compute with constants, a second shader has every number of every expression behind a function whose value only the machine
// knows, and must give the same values.
#include "points.h"
#include "snippets.h"
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace alpenglow::rsl::runner_test {
namespace {

/// A variable, a member, or an element by a number.
bool looksOnly(const std::string& expression) {
    return std::all_of(
               expression.begin(), expression.end(),
               [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '[' || c == ']' || c == '-' || c == '>'; }) &&
           !expression.empty() && !std::isdigit(static_cast<unsigned char>(expression[0])) &&
           expression.find("--") == std::string::npos;
}

const char* const kVeil = "float veil(float x) { return (u < 2) ? x : x + 1; }\n";

std::string typeOf(const Expectation& e, ShaderCompiler& compiler) {
    if (!e.type.empty()) return e.type;
    for (const char* type : {"float", "color", "point", "vector", "normal", "matrix", "string"}) {
        Diagnostics quiet;
        const std::string zero = std::string(type) == "string" ? "\"\"" : "0";
        if (compiler.loadText(std::string("surface probe(output varying ") + type + " r = " + zero + ";) { " + e.setup +
                                  "\n r = (" + e.expression + "); }\n",
                              "probe", quiet))
            return type;
    }
    return "";
}

void compare(const Expectation& e, const std::string& type, const std::vector<float>& got) {
    if (type == "string") {
        EXPECT_EQ(internedString(std::bit_cast<int32_t>(got[0])), e.value) << e.expression;
        return;
    }
    std::istringstream in(e.value);
    std::vector<std::string> words;
    for (std::string w; in >> w;) words.push_back(w);
    if (words.size() == 1) words.resize(got.size(), words[0]);
    ASSERT_EQ(words.size(), got.size()) << e.expression;
    for (size_t k = 0; k < got.size(); k++) {
        if (e.tolerance >= 0) {
            EXPECT_NEAR(double(got[k]), std::atof(words[k].c_str()), e.tolerance) << e.expression << " component " << k;
            continue;
        }
        char text[40];
        std::snprintf(text, sizeof text, "%.7g", double(got[k]));
        // Zero is zero, whatever its sign, unless the expectation says "-0".
        const std::string shown = std::string(text) == "-0" && words[k] == "0" ? "0" : text;
        EXPECT_EQ(shown, words[k]) << e.expression << " component " << k;
    }
}

std::unique_ptr<ShaderCompiler> makeCompiler() {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    return std::make_unique<ShaderCompiler>(settings);
}

/// A shader in every configuration: outputs[k] has the value that cases[k] says, with the same bits everywhere.
void runEverywhere(const std::vector<KernelOptions>& everywhere, ShaderCompiler& compiler,
                   const std::shared_ptr<const CompiledShader>& shader, const std::vector<std::string>& outputs,
                   const std::vector<const Expectation*>& cases, const std::vector<std::string>& types, const std::string& file,
                   Diagnostics& d) {
    const auto defaults = compiler.parameterValues(shader, d);
    std::vector<std::vector<float>> reference;
    for (KernelOptions o : everywhere) {
        SCOPED_TRACE(describe(o));
        o.outputs = outputs;
        const auto kernel = compiler.kernel(shader, o, d);
        ASSERT_TRUE(kernel);
        const int n = kernel->lanes() + 3;
        std::vector<std::vector<float>> out;
        ASSERT_TRUE(runPoints(*kernel, o.mixed, n, evaluationPoint(), defaults, out, d));
        ASSERT_EQ(out.size(), cases.size());
        for (size_t k = 0; k < cases.size(); k++) {
            SCOPED_TRACE(file + ":" + std::to_string(cases[k]->line));
            std::vector<float> last;
            for (size_t c = 0; c < out[k].size(); c += size_t(n)) last.push_back(out[k][c + size_t(n) - 1]);
            for (size_t p = 0; p < out[k].size(); p++)
                ASSERT_TRUE(sameBits(out[k][p], last[p / size_t(n)])) << cases[k]->expression << ": points that are alike differ";
            if (reference.size() < cases.size()) {
                const ir::Kind kind = kernel->outputs()[k].kind;
                compare(*cases[k], types.empty() ? (kind == ir::Kind::String ? "string" : "") : types[k], last);
            } else {
                bool same = last.size() == reference[k].size();
                for (size_t c = 0; same && c < last.size(); c++) same = sameBits(last[c], reference[k][c]);
                EXPECT_TRUE(same) << cases[k]->expression << ": " << formatNumbers(last) << " but " << formatNumbers(reference[k])
                                  << " at 16 lanes, S, O2";
            }
            out[k] = last;
        }
        if (reference.empty()) reference = out;
    }
}

/// What a file runs in: the first, which the others are compared with, and two of the other five, which have other widths and
/// take their turns from file to file. At night all.
std::vector<KernelOptions> configurationsOf(size_t file) {
    const std::vector<KernelOptions> all = configurations();
    return nightly() ? all : std::vector<KernelOptions>{all[0], all[1 + file % 5], all[1 + (file + 2) % 5]};
}
/// For expressions with their numbers as written: what the passes compute of these is the same in all configurations, and what
/// they leave runs behind veils.
std::vector<KernelOptions> fewOf(size_t file) {
    std::vector<KernelOptions> all = configurationsOf(file);
    if (!nightly()) all.pop_back();
    return all;
}

/// Exactly the expected errors and warnings.
void checkProblems(const WholeProgram& program, const std::vector<Diagnostic>& messages) {
    std::vector<bool> used(program.problems.size(), false);
    for (const Diagnostic& m : messages) {
        if (m.severity == Severity::Info) continue;
        bool expected = false;
        for (size_t k = 0; k < used.size() && !expected; k++) {
            const Problem& p = program.problems[k];
            if (used[k] || p.warning != (m.severity == Severity::Warning) || p.line != m.place.line ||
                (p.column && p.column != m.place.column))
                continue;
            if ((m.message + " " + m.hint).find(p.text) == std::string::npos) continue;
            used[k] = expected = true;
        }
        EXPECT_TRUE(expected) << "not expected: " << toString(m);
    }
    for (size_t k = 0; k < used.size(); k++) {
        const Problem& p = program.problems[k];
        EXPECT_TRUE(used[k]) << "not reported: " << p.line << ":" << p.column << ": " << p.text;
    }
}

std::vector<std::string> files();
class Language : public testing::TestWithParam<std::string> {};

TEST_P(Language, Snippets) {
    const fs::path path = fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language" / GetParam();
    const std::string file = path.filename().string();
    const Snippets f = parseSnippets(path);
    for (const auto& b : f.broken) ADD_FAILURE() << path << ":" << b;
    ASSERT_FALSE(f.expectations.empty() && f.programs.empty()) << "nothing is expected in " << path;
    const auto compiler = makeCompiler();
    const std::vector<std::string> all = files();
    const size_t turn = size_t(std::find(all.begin(), all.end(), GetParam()) - all.begin());
    for (const WholeProgram& program : f.programs) {
        SCOPED_TRACE(file + ":" + std::to_string(program.line) + " " + program.name);
        Diagnostics d;
        const auto shader = compiler->loadText(program.source, "snippet", d);
        const bool fails =
            std::any_of(program.problems.begin(), program.problems.end(), [](const Problem& p) { return !p.warning; });
        EXPECT_EQ(shader == nullptr, fails);
        EXPECT_FALSE(program.gives.empty() && program.problems.empty()) << "nothing is said about this program";
        if (shader && !program.gives.empty()) {
            std::vector<std::string> outputs;
            std::vector<const Expectation*> cases;
            for (const Expectation& e : program.gives) {
                outputs.push_back(e.expression);
                cases.push_back(&e);
            }
            runEverywhere(configurationsOf(turn), *compiler, shader, outputs, cases, {}, file, d);
        }
        checkProblems(program, d.all());
    }
    // One block a case keeps their variables apart.
    std::string parameters, plain, behind;
    std::vector<std::string> types, names;
    std::vector<const Expectation*> cases;
    Diagnostics d([](const Diagnostic& m) {
        if (m.severity >= Severity::Error) ADD_FAILURE() << toString(m);
    });
    for (const auto& e : f.expectations) {
        SCOPED_TRACE(file + ":" + std::to_string(e.line));
        if (e.prints) {
            std::string expected;
            for (size_t i = 0; i < e.value.size(); i++)
                if (e.value.compare(i, 2, "\\n") == 0) expected += '\n', i++;
                else expected += e.value[i];
            for (const KernelOptions& o : configurationsOf(turn)) {
                const Evaluation r = evaluate(*compiler, e.setup, e.expression, o, d);
                EXPECT_TRUE(r.ok);
                EXPECT_EQ(r.printed, expected) << describe(o);
            }
            continue;
        }
        const std::string type = typeOf(e, *compiler), zero = type == "string" ? "\"\"" : "0";
        if (type.empty() || !compiler->loadText("surface probe(output varying " + type + " r = " + zero + ";) { " + e.setup +
                                                    "\n r = (" + e.expression + "); }\n",
                                                "probe", d)) {
            ADD_FAILURE() << "does not compile: " << e.expression;
            continue;
        }
        names.push_back("r" + std::to_string(cases.size()));
        parameters += "output varying " + type + " " + names.back() + " = " + zero + ";\n";
        // What only looks at variables shares the block of the case before it with the same setup: there is less to compile.
        const bool shared =
            !cases.empty() && cases.back()->setup == e.setup && looksOnly(cases.back()->expression) && looksOnly(e.expression);
        const auto put = [&](std::string& body, const std::string& expression) {
            if (shared) body.resize(body.size() - 2); // the end of that block
            else body += "{ " + e.setup + "\n";
            body += names.back() + " = (" + expression + "); }\n";
        };
        put(plain, e.expression);
        put(behind, veiled(e.expression));
        types.push_back(type);
        cases.push_back(&e);
    }
    if (cases.empty()) return;
    for (const bool veil : {false, true}) {
        SCOPED_TRACE(veil ? "numbers unknown to the compiler" : "numbers as written");
        const auto shader =
            compiler->loadText("surface cases(" + parameters + ") {\n" + (veil ? kVeil + behind : plain) + "}\n", file, d);
        ASSERT_TRUE(shader);
        runEverywhere(veil ? configurationsOf(turn) : fewOf(turn), *compiler, shader, names, cases, types, file, d);
    }
}

std::vector<std::string> files() {
    std::vector<std::string> all;
    const fs::path root = fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language";
    for (const auto& e : fs::recursive_directory_iterator(root))
        if (e.path().extension() == ".rsl") all.push_back(fs::relative(e.path(), root).string());
    std::sort(all.begin(), all.end());
    return all;
}

// Of the configurations of every day: each value of each choice comes with each value of each other.
TEST(Configurations, EveryTwoChoicesComeTogether) {
    std::set<std::vector<int>> pairs, all;
    const auto note = [](const std::vector<KernelOptions>& from, std::set<std::vector<int>>& to) {
        for (const KernelOptions& o : from) {
            const int choices[] = {o.lanes, o.mixed, o.optimize, o.outline == 0};
            for (int a = 0; a < 4; a++)
                for (int b = a + 1; b < 4; b++) to.insert({a, choices[a], b, choices[b]});
        }
    };
    note(configurations(), pairs);
    note(allConfigurations(), all);
    EXPECT_EQ(all.size(), size_t(3 * 6 + 3 * 4)); // three widths with each of six, three pairs of two choices
    EXPECT_EQ(pairs, all);
    EXPECT_EQ(configurations().front().lanes, 16);
}

INSTANTIATE_TEST_SUITE_P(Files, Language, testing::ValuesIn(files()), [](const auto& i) {
    std::string s = i.param;
    for (char& c : s)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return s;
});

} // namespace
} // namespace alpenglow::rsl::runner_test

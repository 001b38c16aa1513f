// Reads every snippet file (*.rsl) below tests/language and proves what it says. A file holds
//   // setup: STATEMENTS            before every following expression of the file (several lines add up)
//   // expect: EXPR => VALUE        the value as %.7g numbers separated by spaces (or one number for all components), or the text
//   // expect: EXPR => VALUE ~ 1e-6 within an absolute tolerance
//   // expect string: EXPR => TEXT  for strings; also "expect color:", "expect point:" ... to choose the type of the result
//   // prints: EXPR => TEXT         the statement prints exactly TEXT (\n for a line end)
//   or a whole shader with
//   // error LINE:COLUMN: TEXT      each such error must be reported, and no other; LINE counts in the file itself
//   // warning LINE:COLUMN: TEXT
// All expectations of a file go into one shader with one output each, which runs at 4, 8 and 16 lanes, with uniform inputs as
// numbers (S) and in lanes (V), at O0 and O2: the bits must be the same everywhere.
#include "rsl/evaluate.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

namespace fs = std::filesystem;

namespace alpenglow::rsl {
namespace {

struct Expectation {
    int line;
    std::string setup, expression, value, type;
    double tolerance = -1;
    bool prints = false;
};
struct Problem {
    int line, column;
    std::string text;
    bool warning;
};

std::string trim(const std::string& s) {
    const size_t a = s.find_first_not_of(" \t\r"), b = s.find_last_not_of(" \t\r");
    return a == std::string::npos ? "" : s.substr(a, b - a + 1);
}

struct Snippets {
    std::vector<Expectation> expectations;
    std::vector<Problem> problems;
    std::string source;
    std::vector<std::string> broken; ///< lines that look like directives but are none
};

Snippets parse(const fs::path& path) {
    Snippets f;
    std::ifstream in(path);
    std::string line, setup;
    for (int n = 1; std::getline(in, line); n++) {
        f.source += line + "\n";
        const std::string t = trim(line);
        if (t.rfind("// setup:", 0) == 0) {
            setup += t.substr(9) + "\n";
        } else if (t == "// reset") {
            setup.clear();
        } else if (t.rfind("// expect", 0) == 0 || t.rfind("// prints:", 0) == 0) {
            const size_t colon = t.find(':'), arrow = t.rfind("=>");
            Expectation e;
            e.line = n;
            e.setup = setup;
            e.prints = t.rfind("// prints:", 0) == 0;
            if (colon == std::string::npos || arrow == std::string::npos || arrow < colon) {
                f.broken.push_back(std::to_string(n) + ": " + t);
                continue;
            }
            if (!e.prints) e.type = trim(t.substr(9, colon - 9));
            e.expression = trim(t.substr(colon + 1, arrow - colon - 1));
            e.value = trim(t.substr(arrow + 2));
            if (size_t tilde = e.value.find(" ~ "); tilde != std::string::npos && e.type != "string" && !e.prints) {
                e.tolerance = std::atof(e.value.c_str() + tilde + 3);
                e.value = trim(e.value.substr(0, tilde));
            }
            f.expectations.push_back(e);
        } else if (t.rfind("// error ", 0) == 0 || t.rfind("// warning ", 0) == 0) {
            Problem p{0, 0, {}, t[3] == 'w'};
            const char* s = t.c_str() + (p.warning ? 11 : 9);
            char* end = nullptr;
            p.line = int(std::strtol(s, &end, 10));
            if (*end == ':') p.column = int(std::strtol(end + 1, &end, 10));
            if (*end == ':') p.text = trim(end + 1);
            if (p.line <= 0 || p.text.empty()) f.broken.push_back(std::to_string(n) + ": " + t);
            f.problems.push_back(p);
        }
    }
    return f;
}

std::vector<KernelOptions> configurations() {
    std::vector<KernelOptions> all;
    for (int lanes : {16, 8, 4})
        for (bool mixed : {false, true})
            for (int optimize : {2, 0}) {
                KernelOptions o;
                o.lanes = lanes;
                o.mixed = mixed;
                o.optimize = optimize;
                all.push_back(o);
            }
    return all;
}

std::string describe(const KernelOptions& o) {
    return std::to_string(o.lanes) + " lanes, " + (o.mixed ? "V" : "S") + ", O" + std::to_string(o.optimize);
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
    if (a.size() != b.size()) return false;
    for (size_t i = 0; i < a.size(); i++)
        if (std::bit_cast<uint32_t>(a[i]) != std::bit_cast<uint32_t>(b[i]) && !(std::isnan(a[i]) && std::isnan(b[i])))
            return false;
    return true;
}

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

class Language : public testing::TestWithParam<std::string> {};

TEST_P(Language, Snippets) {
    const fs::path path = fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language" / GetParam();
    const Snippets f = parse(path);
    for (const auto& b : f.broken) ADD_FAILURE() << path << ":" << b;
    ASSERT_FALSE(f.expectations.empty() && f.problems.empty()) << "nothing is expected in " << path;
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    if (!f.problems.empty()) {
        Diagnostics d;
        compiler.loadText(f.source, "snippet", d);
        std::vector<bool> used(f.problems.size(), false);
        for (const auto& m : d.all()) {
            bool expected = false;
            for (size_t k = 0; k < f.problems.size(); k++) {
                const Problem& p = f.problems[k];
                if (used[k] || p.warning != (m.severity == Severity::Warning) || p.line != m.place.line ||
                    (p.column && p.column != m.place.column))
                    continue;
                if ((m.message + " " + m.hint).find(p.text) == std::string::npos) continue;
                used[k] = expected = true;
                break;
            }
            if (!expected && m.severity != Severity::Info) { ADD_FAILURE() << "not expected: " << toString(m); }
        }
        for (size_t k = 0; k < used.size(); k++)
            EXPECT_TRUE(used[k]) << "not reported: " << f.problems[k].line << ":" << f.problems[k].column << ": "
                                 << f.problems[k].text;
    }
    // One function a case keeps their variables apart; globals are visible inside as in a shader's body.
    std::string parameters, body;
    std::vector<std::string> types;
    std::vector<const Expectation*> cases, prints;
    for (const auto& e : f.expectations) {
        SCOPED_TRACE(path.filename().string() + ":" + std::to_string(e.line));
        if (e.prints) {
            prints.push_back(&e);
            continue;
        }
        const std::string type = typeOf(e, compiler);
        if (type.empty()) {
            Diagnostics d([](const Diagnostic& m) { ADD_FAILURE() << toString(m); });
            compiler.loadText("surface probe(output varying float r = 0;) { " + e.setup + "\n r = (" + e.expression + "); }\n",
                              "probe", d);
            continue;
        }
        const std::string name = "r" + std::to_string(cases.size());
        parameters += "output varying " + type + " " + name + " = " + (type == "string" ? "\"\"" : "0") + ";\n";
        body += "{ " + e.setup + "\n" + name + " = (" + e.expression + "); }\n";
        types.push_back(type);
        cases.push_back(&e);
    }
    Diagnostics d([](const Diagnostic& m) {
        if (m.severity >= Severity::Error) { ADD_FAILURE() << toString(m); }
    });
    if (!cases.empty()) {
        auto shader = compiler.loadText("surface cases(" + parameters + ") {\n" + body + "}\n", path.filename().string(), d);
        ASSERT_TRUE(shader);
        std::vector<std::vector<float>> reference;
        for (KernelOptions o : configurations()) {
            SCOPED_TRACE(describe(o));
            for (size_t k = 0; k < cases.size(); k++) o.outputs.push_back("r" + std::to_string(k));
            auto kernel = compiler.kernel(shader, o, d);
            ASSERT_TRUE(kernel);
            std::vector<std::vector<float>> out;
            std::string printed;
            const int n = kernel->lanes() + 3;
            ASSERT_TRUE(runAtPoint(*kernel, o.mixed, n, n - 1, out, &printed, d));
            ASSERT_EQ(out.size(), cases.size());
            for (size_t k = 0; k < cases.size(); k++) {
                SCOPED_TRACE(path.filename().string() + ":" + std::to_string(cases[k]->line));
                if (reference.size() < cases.size()) compare(*cases[k], types[k], out[k]);
                else
                    EXPECT_TRUE(sameBits(out[k], reference[k]))
                        << cases[k]->expression << ": " << formatNumbers(out[k]) << " but " << formatNumbers(reference[k])
                        << " at 16 lanes, S, O2";
            }
            if (reference.empty()) reference = out;
        }
    }
    for (const Expectation* e : prints) {
        SCOPED_TRACE(path.filename().string() + ":" + std::to_string(e->line));
        std::string expected;
        for (size_t i = 0; i < e->value.size(); i++)
            if (e->value.compare(i, 2, "\\n") == 0) expected += '\n', i++;
            else expected += e->value[i];
        for (const KernelOptions& o : configurations()) {
            const Evaluation r = evaluate(compiler, e->setup, e->expression, o, d);
            EXPECT_TRUE(r.ok);
            EXPECT_EQ(r.printed, expected) << describe(o);
        }
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

INSTANTIATE_TEST_SUITE_P(Files, Language, testing::ValuesIn(files()), [](const auto& i) {
    std::string s = i.param;
    for (char& c : s)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return s;
});

} // namespace
} // namespace alpenglow::rsl

// docs/language.md is right: every program on the page is compiled and run. In a program, "// error: id" or "// warning:
// id" at the end of a line names the messages that must stand on it (several one after the other, ids of one kind may share the
// word), and
// "// gives NAME = NUMBERS" behind it what an output holds.
#include "points.h"
#include "rsl/compiler.h"
#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sstream>

namespace alpenglow::rsl::manual_test {
namespace {

struct Page {
    int line = 0;
    std::string text;
    std::multiset<std::string> expected; ///< "3 warning no-effect"
    std::vector<std::pair<std::string, std::string>> gives;
};

std::vector<Page> programs() {
    std::vector<Page> all;
    std::ifstream in(ALPENGLOW_SOURCE_DIR "/docs/language.md");
    std::string line;
    bool inside = false;
    int row = 0;
    for (int n = 1; std::getline(in, line); ++n) {
        if (line.rfind("```", 0) == 0) {
            inside = line == "```rsl";
            if (inside) all.push_back({n, "", {}, {}}), row = 0;
            continue;
        }
        if (!inside) continue;
        Page& p = all.back();
        p.text += line + "\n";
        ++row;
        if (line.rfind("// gives ", 0) == 0) {
            const size_t equal = line.find(" = ");
            p.gives.emplace_back(line.substr(9, equal - 9), line.substr(equal + 3));
            continue;
        }
        const size_t error = line.find("// error: "), warning = line.find("// warning: ");
        const size_t at = std::min(error, warning);
        if (at == std::string::npos) continue;
        std::istringstream words(line.substr(at + 3));
        std::string kind;
        for (std::string w; words >> w;) {
            if (w == "error:" || w == "warning:") kind = w.substr(0, w.size() - 1);
            else p.expected.insert(std::to_string(row) + " " + kind + " " + w);
        }
    }
    return all;
}

TEST(Manual, EveryProgramDoesWhatThePageSays) {
    const auto all = programs();
    ASSERT_GE(all.size(), 12u);
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    for (const Page& p : all) {
        SCOPED_TRACE("docs/language.md:" + std::to_string(p.line));
        Diagnostics d;
        const auto shader = compiler.loadText(p.text, "t.sl", d);
        std::multiset<std::string> said;
        for (const Diagnostic& m : d.all())
            said.insert(std::to_string(m.place.line) + (m.severity == Severity::Warning ? " warning " : " error ") + m.id);
        EXPECT_EQ(said, p.expected);
        EXPECT_EQ(shader != nullptr, d.errors() == 0);
        if (!shader || d.errors() > 0) continue;
        KernelOptions o;
        for (const auto& [name, value] : p.gives) o.outputs.push_back(name);
        const auto kernel = compiler.kernel(shader, o, d);
        ASSERT_TRUE(kernel);
        if (p.gives.empty()) continue;
        std::vector<std::vector<float>> out;
        ASSERT_TRUE(runPoints(*kernel, false, 1, evaluationPoint(), compiler.parameterValues(shader, d), out, d));
        for (size_t k = 0; k < p.gives.size(); ++k) {
            std::istringstream numbers(p.gives[k].second);
            for (size_t c = 0; c < out[k].size(); ++c) {
                float wanted = -1;
                EXPECT_TRUE(numbers >> wanted) << p.gives[k].first;
                EXPECT_FLOAT_EQ(out[k][c], wanted) << p.gives[k].first;
            }
        }
    }
}

// What `alpenglow info --shadeops NAME` shows: each has at least one example. Those that need nothing but the point of `alpenglow
// eval` must give the value that stands there; those that need lights, maps or other surfaces must compile.
TEST(Manual, EveryShadeopHasAnExampleThatIsTrue) {
    ShaderCompiler::Settings settings;
    settings.useDefaultCache = false;
    ShaderCompiler compiler(settings);
    int ran = 0;
    for (const Shadeop& op : allShadeops()) {
        if (op.name.rfind("__", 0) == 0) continue; // not for shaders
        EXPECT_FALSE(op.examples.empty()) << op.name;
        for (const Example& e : op.examples) {
            EXPECT_FALSE(e.value.empty()) << op.name;
            Diagnostics d;
            if (!e.when.empty()) {
                bool compiled = false;
                for (const char* kind : {"surface", "light"})
                    for (const char* type : {"float", "color", "point", "string"})
                        compiled |= bool(compiler.loadText(std::string(kind) + " probe(output varying " + type +
                                                               " r = " + (type[0] == 's' ? "\"\"" : "0") + ";) {\n" + e.setup +
                                                               "\nr = " + e.expression + ";\n}\n",
                                                           "probe", d));
                EXPECT_TRUE(compiled) << e.setup << " " << e.expression;
                continue;
            }
            const Evaluation v = evaluate(compiler, e.setup, e.expression, {}, d);
            EXPECT_TRUE(v.ok) << e.setup << " " << e.expression;
            std::string said = v.type.base == Base::Void ? v.printed : v.text;
            if (!said.empty() && said.back() == '\n') said.pop_back(); // print()
            for (size_t at; (at = (" " + said + " ").find(" -0 ")) != std::string::npos;) said.erase(at, 1);
            EXPECT_EQ(said, e.value) << e.setup << " " << e.expression;
            ++ran;
        }
    }
    EXPECT_GT(ran, 120);
}

} // namespace
} // namespace alpenglow::rsl::manual_test

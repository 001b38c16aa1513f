// Erroneous programs and exactly what must be said about them: id, line and column of every message (errors/*.err). A file holds
//   # remarks
//   == lines NAME      each line that follows is a program of its own: the body of a shader (errors/lines.err has its
//   variables)
//   == file NAME       what follows is one program
//   == lint NAME       one program, with the warnings of `compile -W`
//   == kernel NAME     one program, also taken as far as code for it, with the warning about light used non-linearly; the shader
//                      below is bound to it under the handle "layer"
// Below a line of a program stands what is expected there: a caret in the column that is meant, then "warning" if it is one, then
// the id. "^ 7:3 id" names line and column of the program instead. "{{300*(}}" in a program stands for 300 opening parentheses.
#include "base/limits.h"
#include "errorfiles.h"
#include "rsl/compiler.h"
#include "rsl/front/inspect.h"
#include "rsl/messages/messages.h"
#include "rsl/nonlinear.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace fs = std::filesystem;

namespace alpenglow::rsl::errorplaces_test {
namespace {

const char* const kVariables =
    "surface t() { float f, g, h; color c, d; point p, q; vector v1, w; normal n; matrix m, mm; string str; float a[4]; "
    "color ca[3]; shader sh; float open[]; string strs[2];\n";

const char* const kLayer = R"(
class layer(float gain = 1;)
{
    public float count = 0;
    float hidden = 3;
    public color tint(color c; float k) { return c * k * hidden; }
    public void split(float x; output float whole) { whole = floor(x); }
    public float again(float x) { shader h = getshader("layer"); return h->again(x); }
    float mine(float x) { return x; }
})";

std::vector<Said> messages(const Bad& b) {
    Diagnostics d;
    const bool lines = b.mode == "lines";
    if (b.mode == "kernel") {
        ShaderCompiler::Settings settings;
        settings.useDefaultCache = false;
        ShaderCompiler compiler(settings);
        const auto shader = compiler.loadText(b.text, "t.sl", d);
        KernelOptions o;
        Diagnostics quiet;
        const auto layer = compiler.loadText(kLayer, "layer.sl", quiet);
        EXPECT_TRUE(layer);
        if (shader && shader->program().handles && layer) o.coShaders.push_back(ShaderCompiler::coShader(layer, "layer"));
        if (shader) compiler.analyse(*shader, o, d);
        if (shader)
            for (auto& warning : nonlinearUses(shader->program(), shader->shader(), o)) d.report(std::move(warning));
    } else {
        FrontOptions options;
        options.lint = b.mode == "lint";
        compileText(lines ? kVariables + b.text + "\n}" : b.text, "t.sl", options, d);
    }
    std::vector<Said> all;
    for (const Diagnostic& m : d.all())
        all.emplace_back(m.place.line - lines, m.place.column, m.severity == Severity::Warning, m.id);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

std::string shown(const std::vector<Said>& list) {
    std::string s;
    for (const auto& [line, column, warning, id] : list)
        s += "  " + std::to_string(line) + ":" + std::to_string(column) + (warning ? " warning " : " ") + id + "\n";
    return s.empty() ? "  nothing\n" : s;
}

class ErrorPlaces : public ::testing::TestWithParam<std::string> {};

TEST_P(ErrorPlaces, AreExact) {
    const fs::path path = fs::path(ALPENGLOW_SOURCE_DIR) / "tests/language/errors" / (GetParam() + ".err");
    const auto programs = readErrors(path);
    ASSERT_FALSE(programs.empty());
    for (const Bad& b : programs) {
        const auto said = messages(b);
        EXPECT_EQ(said, b.expected) << path.filename().string() << ":" << b.line << ": " << b.name << "\n"
                                    << (b.mode == "lines" ? b.text + "\n" : "") << "expected\n"
                                    << shown(b.expected) << "said\n"
                                    << shown(said);
    }
}

INSTANTIATE_TEST_SUITE_P(Files, ErrorPlaces, ::testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const auto& f : errorFiles()) names.push_back(f.stem().string());
                             return names;
                         }()),
                         [](const auto& i) { return i.param; });

TEST(ErrorPlaces, AfterManyTheFileIsLeft) {
    Diagnostics d;
    std::string text = "surface s() {\n";
    for (int i = 0; i < 2 * limits::kFrontErrors; ++i) text += "nosuch" + std::to_string(i) + "(1);\n";
    EXPECT_EQ(compileText(text + "}\n", "t.sl", {}, d), nullptr);
    ASSERT_EQ(d.errors(), limits::kFrontErrors + 1);
    EXPECT_EQ(d.all().back().id, "too-many-errors");
}

TEST(ErrorPlaces, EveryKindOfMessageAndThreeHundredPrograms) {
    std::set<std::string> ids;
    int wrong = 0;
    for (const auto& f : errorFiles())
        for (const Bad& b : readErrors(f)) {
            wrong += !b.expected.empty();
            for (const Said& s : b.expected) ids.insert(std::get<3>(s));
        }
    EXPECT_GE(wrong, 300);
    // "light-call" comes where no co-shader is bound: its example is tested (messageexamples_test.cpp).
    for (const MessageKind* k : messageKinds())
        if (k->shown != Shown::Elsewhere && std::string_view(k->id) != "light-call")
            EXPECT_TRUE(ids.count(k->id)) << "no program has the message " << k->id;
}

} // namespace
} // namespace alpenglow::rsl::errorplaces_test

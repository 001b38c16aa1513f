// Nothing in the table of shadeops is without a test: every signature is called, and every optional parameter given, in some
// snippet that says what comes out, or in a shader that a rendered test writes; and every shadeop stands in a program that is
// refused for it.
#include "calls.h"
#include "errorfiles.h"
#include "snippets.h"
#include <gtest/gtest.h>
#include <optional>
#include <sstream>

namespace fs = std::filesystem;

namespace alpenglow::rsl::completeness_test {
namespace {

bool internal(const Shadeop& op) { return op.name.rfind("__", 0) == 0; }

std::unique_ptr<Program> compiled(const std::string& text) {
    Diagnostics quiet;
    return compileText(text, "snippet", {}, quiet);
}

/// The calls of an expectation, in the first type that takes it: as the runner does.
void collect(const Expectation& e, Calls& calls) {
    if (e.prints) {
        if (const auto p = compiled("surface probe() { " + e.setup + "\n " + e.expression + "; }\n")) collectCalls(*p, calls);
        return;
    }
    for (const std::string type : {"float", "color", "point", "vector", "normal", "matrix", "string"}) {
        if (!e.type.empty() && e.type != type) continue;
        const auto p = compiled("surface probe(output varying " + type + " r = " + (type == "string" ? "\"\"" : "0") + ";) { " +
                                e.setup + "\n r = (" + e.expression + "); }\n");
        if (!p) continue;
        collectCalls(*p, calls);
        return;
    }
}

Calls ofSnippets() {
    Calls calls;
    for (const auto& entry : fs::recursive_directory_iterator(ALPENGLOW_SOURCE_DIR "/tests/language")) {
        if (entry.path().extension() != ".rsl") continue;
        const Snippets f = parseSnippets(entry.path());
        for (const Expectation& e : f.expectations) collect(e, calls);
        for (const WholeProgram& w : f.programs) {
            const auto p = compiled(w.source);
            if (!p) continue;
            Calls own;
            collectCalls(*p, own);
            // Where nothing is said but a warning, only the calls are proven that can do nothing else.
            for (const Signature* s : own.signatures) {
                const Shadeop* op = findShadeop(s->text.substr(s->text.find(' ') + 1, s->text.find('(') - s->text.find(' ') - 1));
                if (!w.gives.empty() || (op && op->lowering == Lowering::Unavailable)) calls.signatures.insert(s);
            }
            for (const auto& pair : own.pairs)
                if (!w.gives.empty() || pair.first->lowering == Lowering::Unavailable) calls.pairs.insert(pair);
        }
    }
    return calls;
}

/// The texts of a C++ file: adjacent literals are one.
std::vector<std::string> literals(const std::string& code) {
    std::vector<std::string> all;
    std::string text;
    bool open = false;
    for (size_t i = 0; i < code.size();) {
        if (code.compare(i, 3, "R\"(") == 0) {
            const size_t end = code.find(")\"", i + 3);
            if (end == std::string::npos) break;
            text += code.substr(i + 3, end - i - 3);
            open = true;
            i = end + 2;
        } else if (code[i] == '"') {
            for (++i; i < code.size() && code[i] != '"'; ++i) {
                if (code[i] != '\\') text += code[i];
                else if (++i; i < code.size()) text += code[i] == 'n' ? '\n' : code[i];
            }
            open = true;
            ++i;
        } else if (code[i] == '\'') {
            i += code.compare(i, 2, "'\\") == 0 ? 4 : 3;
        } else if (code.compare(i, 2, "//") == 0) {
            i = std::min(code.find('\n', i), code.size());
        } else {
            if (open && !std::isspace(static_cast<unsigned char>(code[i])))
                all.push_back(std::move(text)), text.clear(), open = false;
            ++i;
        }
    }
    return all;
}

/// The shaders that tests of rendered scenes write.
Calls ofRenderedTests() {
    Calls calls;
    for (const char* folder :
         {"world", "services", "integrator", "render", "shading", "plugins", "language", "cli", "pointcloud", "ptex"})
        for (const auto& entry : fs::directory_iterator(fs::path(ALPENGLOW_SOURCE_DIR) / "tests" / folder)) {
            if (!entry.path().string().ends_with("_test.cpp")) continue;
            std::ifstream in(entry.path());
            std::stringstream code;
            code << in.rdbuf();
            for (const std::string& text : literals(code.str())) {
                if (text.find('{') == std::string::npos || text.find('(') == std::string::npos) continue;
                if (const auto p = compiled(text); p && !p->shaders.empty()) collectCalls(*p, calls);
            }
        }
    return calls;
}

TEST(Completeness, EverySignatureAndEveryOptionalParameterIsCalled) {
    const Calls snippets = ofSnippets(), rendered = ofRenderedTests();
    int missing = 0, all = 0;
    std::string list;
    for (const Shadeop& op : allShadeops()) {
        if (internal(op)) continue; // their values are those of the shadeop that calls them
        for (const Signature& s : op.signatures) {
            ++all;
            if (snippets.signatures.count(&s) || rendered.signatures.count(&s)) continue;
            ++missing;
            list += "  " + s.text + "\n";
        }
        for (const OptionalParameter& o : op.optional)
            if (!snippets.pairs.count({&op, o.name}) && !rendered.pairs.count({&op, o.name})) {
                ++missing;
                list += "  " + op.name + " \"" + o.name + "\"\n";
            }
    }
    EXPECT_GT(all, 600);
    EXPECT_EQ(missing, 0) << "nothing calls\n" << list;
}

/// Whether the line of the program, from the column on, begins with the call or lies within its brackets.
bool standsIn(const Bad& b, const std::string& name) {
    std::istringstream in(b.text);
    std::vector<std::string> lines;
    for (std::string l; std::getline(in, l);) lines.push_back(l);
    for (const auto& [line, column, warning, id] : b.expected) {
        if (warning || line < 1 || size_t(line) > lines.size()) continue;
        const std::string& l = lines[size_t(line) - 1];
        for (size_t at = l.find(name); at != std::string::npos; at = l.find(name, at + 1)) {
            const auto letter = [&](size_t i) {
                return i < l.size() && (std::isalnum(static_cast<unsigned char>(l[i])) || l[i] == '_');
            };
            if ((at > 0 && letter(at - 1)) || letter(at + name.size())) continue;
            size_t end = l.find('(', at);
            if (end == std::string::npos) continue;
            for (int depth = 0; end < l.size(); ++end) {
                depth += l[end] == '(' ? 1 : l[end] == ')' ? -1 : 0;
                if (depth == 0 && l[end] == ')') break;
            }
            if (size_t(column) - 1 >= at && size_t(column) - 1 <= end) return true;
        }
    }
    return false;
}

TEST(Completeness, EveryShadeopIsInAProgramThatIsRefusedForIt) {
    std::vector<Bad> programs;
    for (const fs::path& f : errorFiles())
        for (Bad& b : readErrors(f)) programs.push_back(std::move(b));
    int missing = 0;
    std::string list;
    for (const Shadeop& op : allShadeops()) {
        if (internal(op)) continue;
        if (std::any_of(programs.begin(), programs.end(), [&](const Bad& b) { return standsIn(b, op.name); })) continue;
        ++missing;
        list += " " + op.name;
    }
    EXPECT_EQ(missing, 0) << "no program with an error of" << list;
}

} // namespace
} // namespace alpenglow::rsl::completeness_test

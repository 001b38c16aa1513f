// Compiling snippets for the tests of the front end.
#pragma once
#include "rsl/front/print.h"
#include <gtest/gtest.h>
#include <memory>
#include <string>

namespace alpenglow::rsl {

struct Compiled {
    std::unique_ptr<Program> program;
    std::vector<Diagnostic> messages;
    /// "2:5: error: text (hint)", one a line.
    std::string text() const {
        std::string s;
        for (const auto& m : messages)
            s += std::to_string(m.place.line) + ":" + std::to_string(m.place.column) + ": " +
                 (m.severity == Severity::Error ? "error: " : "warning: ") + m.message +
                 (m.hint.empty() ? "" : " (" + m.hint + ")") + "\n";
        return s;
    }
    int errors() const {
        int n = 0;
        for (const auto& m : messages) n += m.severity >= Severity::Error;
        return n;
    }
};

inline Compiled compileSnippet(const std::string& text, const FrontOptions& options = {}, const std::string& name = "t.sl") {
    Compiled c;
    Diagnostics d;
    c.program = compileText(text, name, options, d);
    c.messages = d.all();
    return c;
}

/// Variables that bodies may use; the body begins on line 2.
inline const char* kPrelude = "surface t() { float f, g, h; color c, d; point p, q; vector v1, w; normal n; matrix m, mm; string "
                              "str; float a[4]; color ca[3]; \n";
inline constexpr size_t kPreludeStatements = 9;

inline Compiled compileBody(const std::string& body) { return compileSnippet(kPrelude + body + "\n}"); }

/// The statements of the body, printed; or the messages when it does not compile.
inline std::string printBody(const std::string& body) {
    auto c = compileBody(body);
    if (!c.program) return c.text();
    std::string s;
    const auto& statements = c.program->shaders.at(0)->body->body;
    for (size_t i = kPreludeStatements; i < statements.size(); ++i) s += (s.empty() ? "" : " ") + print(*statements[i]);
    return s;
}

} // namespace alpenglow::rsl

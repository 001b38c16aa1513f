// The text of a snippet file, taken apart. What the directives mean stands in runner_test.cpp.
#pragma once
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace alpenglow::rsl {

struct Expectation {
    int line = 0;
    std::string setup, expression, value, type;
    double tolerance = -1;
    bool prints = false;
};

struct Problem {
    int line, column;
    std::string text;
    bool warning;
};

/// A whole shader file, with blank lines in front so that its lines count as in the snippet file.
struct WholeProgram {
    int line = 1;
    std::string name, source;
    std::vector<Problem> problems;
    std::vector<Expectation> gives; ///< expression is the name of an output
};

struct Snippets {
    std::vector<Expectation> expectations;
    std::vector<WholeProgram> programs;
    std::vector<std::string> broken; ///< lines that look like directives but are none
};

inline std::string trim(const std::string& s) {
    const size_t a = s.find_first_not_of(" \t\r"), b = s.find_last_not_of(" \t\r");
    return a == std::string::npos ? "" : s.substr(a, b - a + 1);
}

inline bool begins(const std::string& s, const char* head) { return s.rfind(head, 0) == 0; }

/// "EXPR => VALUE ~ TOLERANCE" into e; false when there is no arrow.
inline bool parseExpectation(const std::string& text, Expectation& e) {
    const size_t arrow = text.rfind("=>");
    if (arrow == std::string::npos) return false;
    e.expression = trim(text.substr(0, arrow));
    e.value = trim(text.substr(arrow + 2));
    const size_t tilde = e.value.find(" ~ ");
    if (tilde == std::string::npos || e.type == "string" || e.prints) return true;
    e.tolerance = std::atof(e.value.c_str() + tilde + 3);
    e.value = trim(e.value.substr(0, tilde));
    return true;
}

inline Snippets parseSnippets(const std::filesystem::path& path) {
    Snippets f;
    std::ifstream in(path);
    std::string line, setup;
    WholeProgram current;
    bool code = false; // has the current program any text?
    const auto finish = [&] {
        current.source.erase(current.source.find_last_not_of('\n') + 1); // the directives behind it are no part of the text
        if (!current.problems.empty() || !current.gives.empty() || code) f.programs.push_back(current);
        current = {};
        code = false;
    };
    const auto broken = [&](int n, const std::string& t) { f.broken.push_back(std::to_string(n) + ": " + t); };
    for (int n = 1; std::getline(in, line); n++) {
        const std::string t = trim(line);
        bool text = false;
        if (begins(t, "// setup:")) {
            setup += t.substr(9) + "\n";
        } else if (t == "// reset") {
            setup.clear();
        } else if (begins(t, "// program:")) {
            finish();
            current.source.assign(size_t(n - 1), '\n');
            current.line = n;
            current.name = trim(t.substr(11));
        } else if (begins(t, "// expect") || begins(t, "// prints:")) {
            Expectation e;
            e.line = n;
            e.setup = setup;
            e.prints = begins(t, "// prints:");
            const size_t colon = t.find(':');
            if (!e.prints && colon != std::string::npos) e.type = trim(t.substr(9, colon - 9));
            if (colon == std::string::npos || !parseExpectation(t.substr(colon + 1), e)) broken(n, t);
            else f.expectations.push_back(e);
        } else if (begins(t, "// gives:")) {
            Expectation e;
            e.line = n;
            if (!parseExpectation(t.substr(9), e)) broken(n, t);
            else current.gives.push_back(e);
        } else if (begins(t, "// error ") || begins(t, "// warning ")) {
            Problem p{0, 0, {}, t[3] == 'w'};
            const char* s = t.c_str() + (p.warning ? 11 : 9);
            char* end = nullptr;
            p.line = int(std::strtol(s, &end, 10));
            if (*end == ':') p.column = int(std::strtol(end + 1, &end, 10));
            if (*end == ':') p.text = trim(end + 1);
            if (p.line <= 0 || p.text.empty()) broken(n, t);
            current.problems.push_back(p);
        } else {
            text = true;
            code = code || (!t.empty() && !begins(t, "//"));
        }
        current.source += text ? line + "\n" : "\n";
    }
    finish();
    return f;
}

/// Every number of an expression behind a function that no pass can see through: veil(2) + veil(3).
inline std::string veiled(const std::string& s) {
    std::string out;
    for (size_t i = 0; i < s.size();) {
        const auto c = static_cast<unsigned char>(s[i]);
        size_t end = i + 1;
        if (c == '"') {
            while (end < s.size() && s[end] != '"') end += s[end] == '\\' ? 2 : 1;
            end = std::min(end + 1, s.size());
            out += s.substr(i, end - i);
        } else if (std::isalpha(c) || c == '_') {
            while (end < s.size() && (std::isalnum(static_cast<unsigned char>(s[end])) || s[end] == '_')) end++;
            out += s.substr(i, end - i);
        } else if (std::isdigit(c) || (c == '.' && end < s.size() && std::isdigit(static_cast<unsigned char>(s[end])))) {
            char* stop = nullptr;
            std::strtod(s.c_str() + i, &stop);
            end = size_t(stop - s.c_str());
            out += "veil(" + s.substr(i, end - i) + ")";
        } else {
            out += s[i];
        }
        i = end;
    }
    return out;
}

} // namespace alpenglow::rsl

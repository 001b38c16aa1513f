#include "models/standardtext.h"
#include <cctype>
#include <sstream>

namespace alpenglow::models {

namespace {

/// The place behind the bracket that closes the one at `at`; npos: none does. Comments were taken out.
size_t closing(const std::string& t, size_t at) {
    int depth = 0;
    bool quoted = false;
    for (size_t i = at; i < t.size(); ++i) {
        const char c = t[i];
        if (quoted && c == '\\') ++i;
        else if (c == '"') quoted = !quoted;
        else if (!quoted && (c == '(' || c == '{' || c == '[')) ++depth;
        else if (!quoted && (c == ')' || c == '}' || c == ']') && --depth == 0) return i + 1;
    }
    return std::string::npos;
}

std::string trimmed(const std::string& s) {
    size_t a = 0, b = s.size();
    while (a < b && std::isspace(static_cast<unsigned char>(s[a]))) ++a;
    while (b > a && std::isspace(static_cast<unsigned char>(s[b - 1]))) --b;
    return s.substr(a, b - a);
}

std::string withoutComments(const std::string& t) {
    std::string out;
    for (size_t i = 0; i < t.size(); ++i) {
        if (t.compare(i, 2, "/*") == 0) {
            const size_t end = t.find("*/", i);
            if (end == t.npos) break;
            i = end + 1;
        } else {
            out += t[i];
        }
    }
    return out;
}

/// At commas or semicolons that are in no bracket and no string.
std::vector<std::string> pieces(const std::string& t, char at) {
    std::vector<std::string> out(1);
    int depth = 0;
    bool quoted = false;
    for (const char c : t) {
        if (c == '"') quoted = !quoted;
        if (!quoted && (c == '(' || c == '{' || c == '[')) ++depth;
        if (!quoted && (c == ')' || c == '}' || c == ']')) --depth;
        if (c == at && depth == 0 && !quoted) out.emplace_back();
        else out.back() += c;
    }
    return out;
}

/// "varying float base", "base", "map_scale[2]" into type, name and length.
bool declared(const std::string& left, StandardParameter& p) {
    std::istringstream words(left);
    std::vector<std::string> all;
    for (std::string w; words >> w;) all.push_back(w);
    if (all.empty()) return false;
    p.name = all.back();
    if (const size_t b = p.name.find('['); b != p.name.npos) {
        p.array = p.name.substr(b);
        p.name.resize(b);
    }
    all.pop_back();
    if (!all.empty()) p.type.clear();
    for (const std::string& w : all) p.type += (p.type.empty() ? "" : " ") + w;
    return !p.type.empty() && !p.name.empty();
}

} // namespace

std::string StandardParameter::plainType() const {
    const size_t space = type.rfind(' ');
    return space == type.npos ? type : type.substr(space + 1);
}

std::optional<StandardText> takeApart(const std::string& standard) {
    const std::string t = withoutComments(standard);
    StandardText out;
    std::istringstream lines(t);
    for (std::string line; std::getline(lines, line);)
        if (line.rfind("#include", 0) == 0) out.includes.push_back(line);
    const size_t head = t.find("surface standard(");
    if (head == t.npos) return {};
    const size_t open = t.find('(', head), close = closing(t, open);
    if (close == t.npos) return {};
    const size_t brace = t.find('{', close), end = brace == t.npos ? brace : closing(t, brace);
    if (end == t.npos) return {};
    out.body = t.substr(brace + 1, end - brace - 2);
    for (const std::string& group : pieces(t.substr(open + 1, close - open - 2), ';')) {
        if (trimmed(group).empty()) continue;
        StandardParameter p;
        for (const std::string& one : pieces(group, ',')) {
            const size_t equals = one.find('=');
            p.array.clear();
            if (equals == one.npos || !declared(one.substr(0, equals), p)) return {};
            p.value = trimmed(one.substr(equals + 1));
            out.parameters.push_back(p);
        }
    }
    return out;
}

} // namespace alpenglow::models

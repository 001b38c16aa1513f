// Indentation. Lines keep what they say and where they break.
#include "cli/languageserver.h"
#include "cli/lspdocument.h"
#include <algorithm>
#include <cctype>

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

/// What the lines above leave open.
struct Depth {
    struct Open {
        char kind;
        size_t line;
    };
    std::vector<Open> open; ///< '{' and '(' and '[', and the lines in which they are
    size_t line = 0;
    bool comment = false;    ///< inside of /* */
    bool unfinished = false; ///< the statement goes on
    bool head = false;       ///< it is "if (...)", "else" and the like, whose statement comes on the next line
    size_t heads = 0;        ///< of those above one another
    bool directive = false;  ///< a line of the preprocessor that goes on

    bool inList() const { return !open.empty() && open.back().kind != '{'; }
    /// A step for every brace, and one for all the lists that a line opens.
    size_t steps() const {
        size_t n = 0;
        for (size_t i = 0; i < open.size(); ++i) {
            const bool sameList = i > 0 && open[i].kind != '{' && open[i - 1].kind != '{' && open[i - 1].line == open[i].line;
            n += !sameList;
        }
        return n;
    }
};

/// Is this line the head of a statement that follows: "if (...)" with nothing behind it?
bool isHead(std::string_view code) {
    size_t end = 0;
    while (end < code.size() && isWord(code[end])) ++end;
    std::string_view word = code.substr(0, end);
    if (word.empty() && !code.empty() && code[0] == '}')
        return isHead(code.substr(std::min(code.find_first_not_of("} \t"), code.size())));
    if (word == "else") {
        const size_t next = code.find_first_not_of(" \t", end);
        return next == std::string_view::npos || isHead(code.substr(next));
    }
    constexpr std::string_view kHeads[] = {"if", "for", "while", "illuminance", "illuminate", "solar", "gather"};
    return std::find(std::begin(kHeads), std::end(kHeads), word) != std::end(kHeads) && !code.empty() && code.back() == ')';
}

/// Takes a line, without the blanks at its ends, into the depth.
void advance(Depth& d, std::string_view line) {
    ++d.line;
    std::string code; // without comments; strings are a letter
    for (size_t i = 0; i < line.size(); ++i) {
        const char c = line[i], next = i + 1 < line.size() ? line[i + 1] : '\0';
        if (d.comment) {
            if (c == '*' && next == '/') d.comment = false, ++i;
            continue;
        }
        if (c == '/' && next == '/') break;
        if (c == '/' && next == '*') {
            d.comment = true;
            ++i;
            continue;
        }
        if (c == '"') {
            for (++i; i < line.size() && line[i] != '"'; ++i) i += line[i] == '\\';
            code += 's';
            continue;
        }
        code += c;
        if (c == '{' || c == '(' || c == '[') d.open.push_back({c, d.line});
        const char opener = c == '}' ? '{' : c == ')' ? '(' : c == ']' ? '[' : '\0';
        if (opener && !d.open.empty() && d.open.back().kind == opener) d.open.pop_back();
    }
    while (!code.empty() && (code.back() == ' ' || code.back() == '\t')) code.pop_back();
    while (!code.empty() && (code[0] == ' ' || code[0] == '\t')) code.erase(0, 1);
    if (code.empty()) return; // what was unfinished is so still
    d.head = !d.inList() && isHead(code);
    d.heads = d.head ? d.heads + 1 : 0;
    d.unfinished = !d.head && !d.inList() && code.back() != ';' && code.back() != '{' && code.back() != '}';
}

size_t stepsOf(const Depth& d, std::string_view line) {
    const size_t steps = d.steps();
    if (!line.empty() && (line[0] == '}' || line[0] == ')') && steps > 0) return steps - 1;
    if (!line.empty() && line[0] == '{') return steps; // of a head or an unfinished declaration
    if (d.inList()) return steps;
    if (d.head) return steps + d.heads;
    return steps + (d.unfinished && steps > 0); // outside of bodies a type may have a line to itself
}

} // namespace

std::string formatted(const std::string& text, size_t tab, bool spaces) {
    std::string out;
    Depth d;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size());
        std::string_view line = std::string_view(text).substr(at, end - at);
        while (!line.empty() && (line.back() == ' ' || line.back() == '\t' || line.back() == '\r')) line.remove_suffix(1);
        const std::string_view whole = line;
        while (!line.empty() && (line[0] == ' ' || line[0] == '\t')) line.remove_prefix(1);
        const bool directive = d.directive || (!d.comment && !line.empty() && line[0] == '#');
        if (d.comment || d.directive) out += whole; // as its writer laid it out
        else if (directive) out += line;
        else if (!line.empty())
            out += (spaces ? std::string(stepsOf(d, line) * tab, ' ') : std::string(stepsOf(d, line), '\t')) + std::string(line);
        out += '\n';
        d.directive = directive && !line.empty() && line.back() == '\\';
        if (!directive) advance(d, line);
        at = end + 1;
    }
    while (out.size() > 1 && out[out.size() - 1] == '\n' && out[out.size() - 2] == '\n') out.pop_back();
    return out == "\n" ? "" : out;
}

Json LanguageServer::formatting(const Json& params) {
    Document* d = document(params);
    if (!d) return nullptr;
    size_t tab = 4;
    bool spaces = true;
    if (const auto o = params.find("options"); o != params.end() && o->is_object()) {
        if (o->contains("tabSize") && (*o)["tabSize"].is_number_integer())
            tab = size_t(std::clamp<int64_t>((*o)["tabSize"].get<int64_t>(), 1, 16));
        if (o->contains("insertSpaces") && (*o)["insertSpaces"].is_boolean()) spaces = (*o)["insertSpaces"].get<bool>();
    }
    Json edits = Json::array();
    if (d->rib()) return edits; // a scene has no blocks that all writers indent alike
    const std::string now = formatted(d->text(), tab, spaces);
    if (now != d->text()) edits.push_back({{"range", range(*d, 0, d->text().size())}, {"newText", now}});
    return edits;
}

} // namespace alpenglow::cli

#include "rsl/front/advice.h"
#include "rsl/front/ast.h"
#include "rsl/messages/messages.h"
#include <algorithm>
#include <cctype>
#include <string_view>

namespace alpenglow::rsl {

namespace {

/// Words of other languages, and what RSL has instead.
struct Borrowed {
    const char* word;
    const char* instead;
};
constexpr Borrowed kTypes[] = {{"double", "float"}, {"half", "float"},    {"real", "float"},    {"vec2", "vector"},
                               {"vec3", "vector"},  {"vec4", "vector"},   {"float2", "vector"}, {"float3", "vector"},
                               {"float4", "color"}, {"Vector", "vector"}, {"Color", "color"},   {"mat4", "matrix"},
                               {"char", "string"},  {"rgb", "color"}};
constexpr Borrowed kOperators[] = {{"and", "&&"}, {"or", "||"}};

bool isName(const std::string& s) { return !s.empty() && isWord(s[0]) && !std::isdigit(static_cast<unsigned char>(s[0])); }

bool isTriple(const std::string& type) { return type == "color" || type == "point" || type == "vector" || type == "normal"; }

bool is(const Raised& r, const MessageText& text) { return r.message == &text; }
bool is(const Raised& r, const MessageKind& kind) { return &r.message->kind == &kind; }

/// The hint for a triple of one kind where another kind is expected: write the conversion. Empty for other types.
struct Unlike {
    std::string there, wanted;
};
Unlike unlike(const Raised& r) {
    Unlike u;
    if (is(r, msg::kBadAssignment)) u = {r.arguments[0], r.arguments[1]};
    else if (is(r, msg::kTypeMismatch)) u = {r.arguments[1], r.arguments[0]};
    if (!isTriple(u.there) || !isTriple(u.wanted) || (u.there == "color") == (u.wanted == "color")) return {};
    return u;
}

/// The operator of RSL for a word of another language; null if there is none.
const char* operatorOf(const std::string& word) {
    const auto b = std::ranges::find_if(kOperators, [&](const Borrowed& o) { return word == o.word; });
    return b == std::end(kOperators) ? nullptr : b->instead;
}

bool operatorFits(const Raised& r) { return is(r, msg::kExpectedSemicolonBefore) || is(r, msg::kKindExpectedToken); }

} // namespace

/// The name in "did you mean 'x'?", in either kind of quotes; empty if there is none.
std::string suggestion(const std::string& hint) {
    constexpr std::string_view kHead = "did you mean ";
    if (hint.compare(0, kHead.size(), kHead) != 0 || hint.size() < kHead.size() + 3) return {};
    const char quote = hint[kHead.size()];
    const size_t end = hint.rfind(quote);
    if ((quote != '\'' && quote != '"') || end <= kHead.size() + 1) return {};
    return hint.substr(kHead.size() + 1, end - kHead.size() - 1);
}

/// The kinds of shaders that have the variable, in words.
static std::string shadersWith(const std::string& variable) {
    std::string where;
    for (int k = 0; k < 6; ++k)
        for (const GlobalVariable& g : globalVariables(ShaderKind(k)))
            if (variable == g.name) where += (where.empty() ? "" : ", ") + std::string(toString(ShaderKind(k)));
    return where;
}

/// Does a declaration of a variable begin the line?
static bool declares(const std::string& line, size_t at) {
    const size_t word = line.find_first_not_of(" \t");
    if (word == std::string::npos || at <= word) return false;
    return std::ranges::any_of(std::initializer_list<std::string_view>{"float ", "color ", "point ", "vector ", "normal ",
                                                                       "matrix ", "string ", "uniform ", "varying "},
                               [&](std::string_view type) { return line.compare(word, type.size(), type) == 0; });
}

/// The component that `.x` or `.r` means in other languages, from 0; or -1.
static int componentOf(const std::string& line, const std::string& written, size_t at) {
    if (written.size() != 1 || at == 0 || at >= line.size() || line[at - 1] != '.') return -1;
    const size_t part = std::string_view("xyzrgb").find(written[0]);
    return part == std::string_view::npos ? -1 : int(part % 3);
}

void advise(Diagnostic& d, const Raised& r, const std::string& written, size_t at) {
    if (!written.empty() && suggestion(d.hint) == written) d.hint.clear();
    if (is(r, msg::kNotAType)) {
        for (const Borrowed& b : kTypes)
            if (written == b.word) d.hint = std::string("did you mean '") + b.instead + "'?";
        if (written == "then") d.hint = "there is no 'then': if (condition) statement else statement";
        return;
    }
    if (is(r, msg::kUndeclaredIn)) { // a variable of other kinds of shaders is no misspelling
        if (const std::string where = shadersWith(written); !where.empty())
            d.hint = "it is a variable of these shaders: " + where;
        return;
    }
    if (!d.hint.empty()) return;
    if (const int part = componentOf(d.sourceLine, written, at); part >= 0 && is(r, msg::kUndeclared)) {
        const std::string n = std::to_string(part);
        d.hint = "'.' is the dot product; a component is v[" + n + "] or comp(v, " + n + ")";
    } else if (is(r, msg::kStrayCharacter) && written == "'") {
        d.hint = "a string stands in double quotes";
    } else if (const char* op = operatorOf(written); op && operatorFits(r)) {
        d.hint = std::string("did you mean '") + op + "'?";
    } else if (is(r, msg::kExpectedSemicolonBefore) && written == "{") {
        d.hint = "a block belongs to a statement of the language: if, while, for, illuminance ...";
    } else if (is(r, msg::kExpectedSemicolonBefore) && written == ")") {
        const bool ofFor = r.arguments[0].ends_with("of 'for'");
        d.hint = ofFor ? "the parts of 'for' are separated by ';'" : "this ')' closes nothing";
    } else if (is(r, msg::kExpectedDefinition) && declares(d.sourceLine, at)) {
        d.hint = "variables stand inside of shaders and functions; what all may read is a #define";
    } else if (is(r, msg::kTypeMismatch) && written == "{" && r.arguments[1].starts_with("an array of 3")) {
        d.hint = "a triple is written (1, 2, 3)";
    } else if (const Unlike u = unlike(r); !u.there.empty()) {
        d.hint = "a written conversion, as in " + u.wanted + " x, makes one of the other";
    }
}

void addFix(Diagnostic& d, const Raised& r, const std::string& written, size_t at) {
    const std::string& line = d.sourceLine;
    const auto put = [&](size_t column, int length, std::string text) {
        d.fixes.push_back({{d.place.file, d.place.line, int(column) + 1}, length, std::move(text)});
    };
    const char* op = operatorFits(r) ? operatorOf(written) : nullptr;
    if (op) put(at, int(written.size()), op);
    else if (is(r, msg::kExpectedSemicolon) || is(r, msg::kExpectedSemicolonParameter)) put(at, 0, ";");
    else if (is(r, msg::kSemicolonInCall) && written == ";") put(at, 1, ",");
    else if (is(r, msg::kAssignmentCondition) && written == "=") put(at, 1, "==");
    else if (is(r, msg::kTrailingComma) && written == ",") put(at, 1, "");
    else if (is(r, msg::kMemberDot) && written == ".") put(at, 1, "->");
    else if ((is(r, msg::kExpectedArgumentEnd) || is(r, msg::kExpectedClosing)) && written == ";") put(at, 0, ")");
    else if (is(r, msg::kNumberSuffix)) {
        size_t digits = written.size();
        while (digits > 0 && std::isalpha(static_cast<unsigned char>(written[digits - 1]))) --digits;
        if (digits > 0 && digits < written.size()) put(at, int(written.size()), written.substr(0, digits));
    } else if (is(r, msg::kNotAType)) {
        for (const Borrowed& b : kTypes)
            if (written == b.word) put(at, int(written.size()), b.instead);
    } else if (is(r, msg::kExpectedSemicolonBefore) && isName(written) && r.arguments[1] == "'" + written + "'" && at > 0) {
        // A statement that begins on the same line behind one without its ';'.
        const size_t end = line.find_last_not_of(" \t", at - 1);
        if (end != std::string::npos) put(end + 1, 0, ";");
    } else if (const int part = componentOf(line, written, at);
               part >= 0 && is(r, msg::kUndeclared) && at > 1 && d.hint.starts_with("'.' is the dot product") &&
               (isWord(line[at - 2]) || line[at - 2] == ')') && !isWord(at + 1 < line.size() ? line[at + 1] : ' ')) {
        put(at - 1, 2, "[" + std::to_string(part) + "]");      // v.x: a component, not a product
    } else if (const Unlike u = unlike(r); !u.there.empty()) { // one variable of another kind of triple
        size_t value = at + (written == "=" ? 1 : 0);
        while (value < line.size() && line[value] == ' ') ++value;
        size_t end = value;
        while (end < line.size() && isWord(line[end])) ++end;
        const size_t next = std::min(line.find_first_not_of(' ', end), line.size());
        if (end > value && isName(line.substr(value, 1)) && next < line.size() &&
            std::string_view(";,)").find(line[next]) != std::string_view::npos)
            put(value, 0, u.wanted + " ");
    }
}

} // namespace alpenglow::rsl

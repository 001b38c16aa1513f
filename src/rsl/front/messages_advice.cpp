#include "rsl/front/messages_advice.h"
#include "rsl/front/ast.h"
#include <algorithm>
#include <cctype>
#include <string_view>

namespace alpenglow::rsl {

namespace {

/// Words of other languages, and what stands there in this one.
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

/// "cannot assign A to B", "expected a B, not A": what is there and what is wanted, both kinds of triples; else nothing.
struct Unlike {
    std::string there, wanted;
};
Unlike unlike(const Diagnostic& d) {
    const auto between = [&](std::string_view a, std::string_view b) {
        const size_t begin = d.message.find(a);
        if (begin == std::string::npos) return std::string();
        const size_t from = begin + a.size(), end = b.empty() ? d.message.size() : d.message.find(b, from);
        return end == std::string::npos ? std::string() : d.message.substr(from, end - from);
    };
    Unlike u;
    if (d.id == "bad-assignment") u = {between("cannot assign ", " to "), between(" to ", "")};
    else if (d.id == "type-mismatch") u = {between(", not ", ""), between("expected a ", ", not ")};
    if (!isTriple(u.there) || !isTriple(u.wanted)) return {};
    return u;
}

/// Is the missing bracket that the message asks for what ends a call or a pair of brackets before a ';'?
bool bracketMissing(const Diagnostic& d) {
    return d.id == "expected-token" &&
           (d.message == "expected ',' or ')' after an argument before ';'" || d.message == "expected ')' before ';'");
}

} // namespace

/// What stands between the quotes of "did you mean 'x'?", either kind of quotes; or nothing.
std::string suggestion(const std::string& hint) {
    constexpr std::string_view kHead = "did you mean ";
    if (hint.compare(0, kHead.size(), kHead) != 0 || hint.size() < kHead.size() + 3) return {};
    const char quote = hint[kHead.size()];
    const size_t end = hint.rfind(quote);
    if ((quote != '\'' && quote != '"') || end <= kHead.size() + 1) return {};
    return hint.substr(kHead.size() + 1, end - kHead.size() - 1);
}

void advise(Diagnostic& d, const std::string& written, size_t at) {
    const std::string& line = d.sourceLine;
    const auto is = [&](const char* id) { return d.id == id; };
    const auto says = [&](const char* text) { return d.message.find(text) != std::string::npos; };
    if (!written.empty() && suggestion(d.hint) == written) d.hint.clear();
    if (is("not-a-type")) {
        for (const Borrowed& b : kTypes)
            if (written == b.word) d.hint = std::string("did you mean '") + b.instead + "'?";
        if (written == "then") d.hint = "there is no 'then': if (condition) statement else statement";
        return;
    }
    if (is("undeclared") && says("is not declared in a ")) {
        // A variable of other kinds of shaders is no misspelling.
        std::string where;
        for (int k = 0; k < 6; ++k)
            for (const GlobalVariable& g : globalVariables(ShaderKind(k)))
                if (written == g.name) where += (where.empty() ? "" : ", ") + std::string(toString(ShaderKind(k)));
        if (!where.empty()) d.hint = "it is a variable of these shaders: " + where;
        return;
    }
    if (!d.hint.empty()) return;
    const size_t part = written.size() == 1 && at > 0 && at < line.size() && line[at - 1] == '.'
                            ? std::string("xyzrgb").find(written)
                            : std::string::npos;
    if (is("undeclared") && part != std::string::npos) {
        const std::string n = std::to_string(part % 3);
        d.hint = "'.' is the dot product; a component is v[" + n + "] or comp(v, " + n + ")";
    } else if (is("stray-character") && written == "'") {
        d.hint = "a string stands in double quotes";
    } else if (is("expected-semicolon") && says(" before '")) {
        for (const Borrowed& b : kOperators)
            if (written == b.word) d.hint = std::string("did you mean '") + b.instead + "'?";
        if (written == "{") d.hint = "a block belongs to a statement of the language: if, while, for, illuminance ...";
        if (written == ")") d.hint = says("of 'for'") ? "the parts of 'for' are separated by ';'" : "this ')' closes nothing";
    } else if (is("expected-token") && says(" before '")) {
        for (const Borrowed& b : kOperators)
            if (written == b.word) d.hint = std::string("did you mean '") + b.instead + "'?";
    } else if (is("expected-definition")) {
        const size_t word = line.find_first_not_of(" \t");
        for (const std::string_view type :
             {"float ", "color ", "point ", "vector ", "normal ", "matrix ", "string ", "uniform ", "varying "})
            if (word != std::string::npos && line.compare(word, type.size(), type) == 0 && at > word)
                d.hint = "variables stand inside of shaders and functions; what all may read is a #define";
    } else if (is("no-shader")) {
        d.hint = "a shader begins with surface, displacement, light, volume, imager or class, and its name";
    } else if (is("type-mismatch") && written == "{" && says("not an array of 3")) {
        d.hint = "a triple is written (1, 2, 3)";
    } else if (is("member-dot")) {
        d.hint = "a member of a structure is read by '->'";
    } else if (const Unlike u = unlike(d); !u.there.empty() && (u.there == "color") != (u.wanted == "color")) {
        d.hint = "a written conversion, as in " + u.wanted + " x, makes one of the other";
    }
}

void addFix(Diagnostic& d, const std::string& written, size_t at) {
    const std::string& line = d.sourceLine;
    const auto put = [&](size_t column, int length, std::string text) {
        d.fixes.push_back({{d.place.file, d.place.line, int(column) + 1}, length, std::move(text)});
    };
    if (d.id == "assignment-condition" && written == "=") put(at, 1, "==");
    if (d.id == "trailing-comma" && written == ",") put(at, 1, "");
    if (d.id == "member-dot" && written == ".") put(at, 1, "->");
    if (bracketMissing(d) && written == ";") put(at, 0, ")");
    for (const Borrowed& b : kTypes)
        if (d.id == "not-a-type" && written == b.word) put(at, int(written.size()), b.instead);
    bool operators = false;
    for (const Borrowed& b : kOperators)
        if ((d.id == "expected-semicolon" || d.id == "expected-token") && written == b.word)
            operators = true, put(at, int(written.size()), b.instead);
    // A statement that begins on the same line behind one without its ';'.
    if (d.id == "expected-semicolon" && !operators && isName(written) && d.message.ends_with(" before '" + written + "'") &&
        at > 0) {
        size_t end = at;
        while (end > 0 && (line[end - 1] == ' ' || line[end - 1] == '\t')) --end;
        if (end > 0) put(end, 0, ";");
    }
    // v.x: a component, not a product.
    if (d.id == "undeclared" && d.hint.rfind("'.' is the dot product", 0) == 0 && at > 1 &&
        (isWord(line[at - 2]) || line[at - 2] == ')') && !isWord(at + 1 < line.size() ? line[at + 1] : ' '))
        put(at - 1, 2, d.hint.substr(d.hint.find('['), 3));
    // One variable of another kind of triple.
    if (const Unlike u = unlike(d); !u.there.empty() && (u.there == "color") != (u.wanted == "color")) {
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

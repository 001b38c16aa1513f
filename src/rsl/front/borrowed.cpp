#include "rsl/front/borrowed.h"
#include <algorithm>
#include <set>
#include <string>

namespace alpenglow::rsl::front {
namespace {

bool isOneOf(const Token& t, std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return t.is(w); });
}

bool isType(const Token& t) {
    return isOneOf(t, {"float", "color", "point", "vector", "normal", "matrix", "string", "bool", "int", "integer"});
}

} // namespace

void hashComments(SourceSet& sources, Preprocessed& p) {
    std::vector<Token> kept;
    size_t next = 0; // annotation; they are in the order of the text
    const auto passed = [&](size_t token) {
        for (; next < p.annotations.size() && p.annotations[next].token <= token; ++next) p.annotations[next].token = kept.size();
    };
    for (size_t i = 0; i < p.tokens.size();) {
        const Token& t = p.tokens[i];
        const bool two = t.text == "##" && t.kind != Tok::String; // of macros it is gone by now
        const bool hash = two || (t.text == "#" && !t.lineStart && t.kind != Tok::String && t.kind != Tok::End);
        passed(i);
        if (!hash) {
            kept.push_back(p.tokens[i++]);
            continue;
        }
        sources.report(t.place, two ? Raised(msg::kTwoHashComment) : Raised(msg::kHashComment));
        const Place line = t.place;
        while (i < p.tokens.size() && p.tokens[i].kind != Tok::End && p.tokens[i].place.file == line.file &&
               p.tokens[i].place.line == line.line)
            ++i;
    }
    p.tokens = std::move(kept);
}

void readBorrowedWords(SourceSet& sources, Preprocessed& p) {
    std::vector<Token>& tokens = p.tokens;
    const Token none;
    const auto at = [&](size_t i) -> const Token& { return i < tokens.size() ? tokens[i] : none; };
    bool ownTruth = false; // variables or functions of these names
    for (size_t i = 0; i < tokens.size(); ++i)
        if (isOneOf(tokens[i], {"true", "false"}))
            ownTruth |= isOneOf(at(i + 1), {"=", "(", "["}) || (i > 0 && isType(tokens[i - 1]));
    std::set<std::string_view> reported;
    for (size_t i = 0; i < tokens.size(); ++i) {
        Token& t = tokens[i];
        if (t.kind != Tok::Identifier) continue;
        if (!ownTruth && isOneOf(t, {"true", "false"})) {
            t.kind = Tok::Number;
            t.text = t.text == "true" ? "1" : "0";
        } else if (isOneOf(t, {"bool", "int", "integer"}) && at(i + 1).kind == Tok::Identifier) {
            const bool begins = i == 0 || isOneOf(tokens[i - 1], {";", "{", "}", "(", ",", "uniform", "varying", "output",
                                                                  "public", "private", "constant", "const", "extern"});
            if (!begins) continue;
            if (reported.insert(t.text).second) sources.report(t.place, msg::kBorrowedType(t.text));
            t.text = "float";
        }
    }
}

void readLitPoints(Preprocessed& p) {
    std::vector<Token>& t = p.tokens;
    for (size_t i = 0; i + 2 < t.size(); ++i) {
        if (!t[i].is("light") || t[i + 1].kind != Tok::Identifier || !t[i + 2].is("(")) continue;
        const size_t body = behind(t, i + 2);
        if (body >= t.size() || !t[body].is("{")) continue;
        const size_t end = behind(t, body);
        for (size_t k = i + 3; k < end; ++k)
            if (t[k].kind == Tok::Identifier && t[k].text == "P" && !t[k - 1].is("->")) t[k].text = "Ps";
        i = end - 1;
    }
}

size_t behind(const std::vector<Token>& t, size_t open) {
    int depth = 0;
    for (size_t i = open; i < t.size(); ++i) {
        if (t[i].is("(") || t[i].is("{") || t[i].is("[")) ++depth;
        if ((t[i].is(")") || t[i].is("}") || t[i].is("]")) && --depth == 0) return i + 1;
    }
    return t.size();
}

} // namespace alpenglow::rsl::front

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
    std::vector<size_t> dropped; // how many, up to each token
    for (size_t i = 0; i < p.tokens.size();) {
        const Token& t = p.tokens[i];
        const bool two = t.text == "##" && t.kind != Tok::String; // of macros it is gone by now
        const bool hash = two || (t.text == "#" && !t.lineStart && t.kind != Tok::String && t.kind != Tok::End);
        if (!hash) {
            dropped.push_back(i - kept.size());
            kept.push_back(p.tokens[i++]);
            continue;
        }
        sources.report(t.place, two ? Raised(msg::kTwoHashComment) : Raised(msg::kHashComment));
        const Place line = t.place;
        for (; i < p.tokens.size() && p.tokens[i].kind != Tok::End && p.tokens[i].place.file == line.file &&
               p.tokens[i].place.line == line.line;
             ++i)
            dropped.push_back(i - kept.size());
    }
    for (Annotation& a : p.annotations) a.token -= a.token < dropped.size() ? dropped[a.token] : 0;
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
    std::set<std::string_view> said;
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
            if (said.insert(t.text).second) sources.report(t.place, msg::kBorrowedType(t.text));
            t.text = "float";
        }
    }
}

} // namespace alpenglow::rsl::front

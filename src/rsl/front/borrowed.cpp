#include "rsl/front/borrowed.h"
#include <algorithm>
#include <set>
#include <string>

namespace alpenglow::rsl::front {
namespace {

bool isOneOf(const Token& t, std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return t.is(w); });
}

bool isType(const Token& t) { return isOneOf(t, {"float", "color", "point", "vector", "normal", "matrix", "string", "bool", "int", "integer"}); }

} // namespace

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
            const bool begins = i == 0 || isOneOf(tokens[i - 1], {";", "{", "}", "(", ",", "uniform", "varying", "output", "public", "private", "constant", "const", "extern"});
            if (!begins) continue;
            if (said.insert(t.text).second) sources.warning(t.place, "there is no type '" + std::string(t.text) + "'; float is taken, numbers are not rounded");
            t.text = "float";
        }
    }
}

} // namespace alpenglow::rsl::front

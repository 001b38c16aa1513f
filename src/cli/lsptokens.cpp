// Semantic tokens: what each name of a text is, for editors that colour by meaning.
#include "cli/languageserver.h"
#include "shadeops/descriptor.h"
#include <algorithm>
#include <array>

namespace alpenglow::cli {

using Json = nlohmann::json;

namespace {

constexpr std::array kTypes = {"variable", "parameter", "property", "function", "method", "struct", "class", "macro"};
enum TokenType { Variable, Parameter, Property, Function, Method, Struct, Class, Macro, NoToken };
constexpr std::array kModifiers = {"declaration", "readonly", "defaultLibrary"};
enum Modifier : unsigned { kDeclaration = 1, kReadonly = 2, kDefaultLibrary = 4 };

struct Token {
    TokenType type = NoToken;
    unsigned modifiers = 0;
};

Token ofSymbol(const Document& d, const rsl::Symbol& s, size_t at) {
    using Origin = rsl::Symbol::Origin;
    Token t{s.origin == Origin::ShaderParameter || s.origin == Origin::FunctionParameter ? Parameter : Variable, 0};
    if (s.origin == Origin::Global) t.modifiers |= kDefaultLibrary;
    else if (d.isHere(s.place) && d.offset(size_t(s.place.line) - 1, size_t(s.place.column) - 1) == at)
        t.modifiers |= kDeclaration;
    if (!s.writable || s.isConstant) t.modifiers |= kReadonly;
    return t;
}

Token tokenOf(const Document& d, const Document::Word& w, const std::map<size_t, Document::Use>& uses) {
    const std::string name = d.text().substr(w.begin, w.end - w.begin);
    if (d.macro(name)) return {Macro, w.directive ? unsigned(kDeclaration) : 0u};
    if (w.directive) return {};
    if (const auto r = d.receiver(w.begin))
        for (const auto& m : d.members(*r, w.begin))
            if (m.name == name) return {m.method ? Method : Property, 0};
    if (const auto at = uses.find(w.begin); at != uses.end()) {
        const Document::Use& u = at->second;
        if (u.symbol) return ofSymbol(d, *u.symbol, w.begin);
        if (u.shadeop) return {Function, kDefaultLibrary};
        if (u.shader) return {Class, kDeclaration};
        if (u.function) {
            const auto& p = u.function->place;
            const bool here = d.isHere(p) && d.offset(size_t(p.line) - 1, size_t(p.column) - 1) == w.begin;
            return {Function, here ? unsigned(kDeclaration) : 0u};
        }
    }
    if (d.structure(name)) return {Struct, 0};
    const auto& keywords = languageKeywords();
    if (std::find(keywords.begin(), keywords.end(), name) != keywords.end()) return {}; // the grammar's
    if (shadeops::findShadeop(name)) return {Function, kDefaultLibrary};
    if (const auto u = d.named(w.begin); u.symbol) return ofSymbol(d, *u.symbol, w.begin);
    return {};
}

} // namespace

Json tokenLegend() { return {{"tokenTypes", kTypes}, {"tokenModifiers", kModifiers}}; }

Json LanguageServer::semanticTokens(const Json& params) {
    Document* d = document(params);
    if (!d) return nullptr;
    Json data = Json::array();
    if (d->rib()) return {{"data", data}};
    const auto uses = d->uses();
    size_t line = 0, column = 0;
    for (const Document::Word& w : d->words()) {
        const Token t = tokenOf(*d, w, uses);
        if (t.type == NoToken) continue;
        const size_t n = d->lineOf(w.begin), c = units(d->line(n), w.begin - d->startOf(n));
        for (const size_t v : {n - line, n == line ? c - column : c, w.end - w.begin, size_t(t.type), size_t(t.modifiers)})
            data.push_back(v);
        line = n;
        column = c;
    }
    return {{"data", std::move(data)}};
}

} // namespace alpenglow::cli

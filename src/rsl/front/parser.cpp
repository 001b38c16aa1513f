#include "rsl/front/parser.h"
#include "base/limits.h"
#include <tuple>
#include <utility>

namespace alpenglow::rsl::front {

std::optional<Base> baseNamed(std::string_view s) {
    if (s == "float") return Base::Float;
    if (s == "color") return Base::Color;
    if (s == "point") return Base::Point;
    if (s == "vector") return Base::Vector;
    if (s == "normal") return Base::Normal;
    if (s == "matrix") return Base::Matrix;
    if (s == "string") return Base::String;
    if (s == "void") return Base::Void;
    return std::nullopt;
}

std::optional<ShaderKind> shaderKindNamed(std::string_view s) {
    if (s == "surface") return ShaderKind::Surface;
    if (s == "displacement") return ShaderKind::Displacement;
    if (s == "light") return ShaderKind::Light;
    if (s == "volume") return ShaderKind::Volume;
    if (s == "imager") return ShaderKind::Imager;
    if (s == "transformation") return ShaderKind::Transformation;
    return std::nullopt;
}

// ---- tokens

const Token& Parser::take() {
    const Token& t = peek();
    if (at_ + 1 < tokens_->size()) ++at_;
    return t;
}

bool Parser::accept(std::string_view s) {
    if (!at(s)) return false;
    take();
    return true;
}

std::string Parser::shown() const {
    const Token& t = peek();
    if (t.kind == Tok::End) return "the end of the file";
    return "'" + std::string(t.text.substr(0, 40)) + "'";
}

Place Parser::endOfLast() const {
    if (at_ == 0) return peek().place;
    const Token& last = (*tokens_)[at_ - 1];
    return {last.place.file, last.place.line, last.place.column + int(last.text.size())};
}

void Parser::fail(Place p, const Raised& message, std::string hint) {
    // One message for one place: what follows while we are still there is a consequence.
    if (lastError_ != at_ && !atCut()) sources_.report(p, message, std::move(hint));
    lastError_ = at_;
    throw SyntaxError{};
}

void Parser::failHere(const Raised& expected) {
    if (peek().kind == Tok::Invalid && peek().text.empty()) { // reported where it was made
        lastError_ = at_;
        throw SyntaxError{};
    }
    if (peek().kind == Tok::Invalid)
        fail(peek().place, peek().text[0] == '"' ? Raised(msg::kUnfinishedString) : msg::kStrayCharacter(shown()));
    fail(peek().place, expected);
}

void Parser::expect(std::string_view s, const char* where) {
    if (accept(s)) return;
    failHere(msg::kExpectedToken("'" + std::string(s) + "'" + (*where ? " " : "") + where, shown()));
}

void Parser::expectSemicolon(const char* after) {
    if (accept(";")) return;
    const bool newLine = peek().lineStart || at("}") || peek().kind == Tok::End;
    if (!newLine || peek().kind == Tok::Invalid) failHere(msg::kExpectedSemicolonBefore(after, shown()));
    // Missing at the end of a line: reported there, and parsing continues as if it were present.
    if (!atCut()) sources_.report(endOfLast(), msg::kExpectedSemicolon(after));
}

void Parser::expectSeparator(const char* after) {
    if (!accept(";")) failHere(msg::kExpectedSemicolonBefore(after, shown()));
}

/// At an opening bracket: over everything up to the one that closes it.
void Parser::skipBalanced() {
    int depth = 0;
    do {
        const Token& t = peek();
        if (t.kind == Tok::End) return;
        if (t.kind == Tok::Punct) {
            if (t.text == "(" || t.text == "{" || t.text == "[") ++depth;
            if (t.text == ")" || t.text == "}" || t.text == "]") --depth;
        }
        take();
    } while (depth > 0);
}

/// After an error in a statement: behind its ';', or before the '}' that closes the block.
void Parser::recover() {
    for (;;) {
        if (peek().kind == Tok::End || at("}")) return;
        if (at("{")) {
            skipBalanced();
            return;
        }
        if (take().is(";")) return;
    }
}

void Parser::skippedFrom(size_t begin) {
    for (size_t n = begin; n < at_ && n < tokens_->size(); ++n)
        if ((*tokens_)[n].kind == Tok::Identifier) unit_.skipped.emplace((*tokens_)[n].text);
}

Parser::Depth::Depth(Parser& p) : parser(p) {
    if (++p.depth_ <= limits::kExpressionDepth) return;
    --p.depth_;
    const bool first = !p.tooDeep_;
    p.tooDeep_ = true;
    p.unit_.incomplete = true;
    const Place at = p.peek().place;
    p.at_ = p.tokens_->size() - 1; // no use in reading on
    if (first) p.sources_.report(at, msg::kTooDeep(limits::kExpressionDepth));
    p.lastError_ = p.at_;
    throw SyntaxError{};
}

bool Parser::atTypeName(size_t k) const {
    const Token &t = peek(k), &n = peek(k + 1);
    if (t.kind != Tok::Identifier) return false;
    if (!baseNamed(t.text)) {
        // Names of structures, and "shader", are types only where a name follows.
        if (!t.is("shader") && !structs_.count(std::string(t.text))) return false;
        return n.kind == Tok::Identifier || (n.is("[") && (peek(k + 2).is("]") || peek(k + 2).kind == Tok::Number));
    }
    if (typeWords_.empty() || !typeWords_.count(t.text)) return true;
    // A variable of that name: it is the type only where a value or a name follows.
    return n.kind == Tok::Identifier || n.kind == Tok::Number || n.kind == Tok::String || n.is("(");
}

bool Parser::atName() const {
    if (peek().kind != Tok::Identifier) return false;
    if (!baseNamed(peek().text)) return true;
    if (!at("vector") && !at("normal") && !at("matrix")) return false;
    const Token& n = peek(1);
    return n.is("=") || n.is(";") || n.is(",") || n.is(")");
}

const Token& Parser::takeName() {
    const Token& t = take();
    if (baseNamed(t.text)) typeWords_.insert(t.text);
    return t;
}

Type Parser::takeType() {
    const std::string name(take().text);
    if (const auto base = baseNamed(name)) return {*base, 0};
    if (const auto s = structs_.find(name); s != structs_.end()) return structType(size_t(s->second));
    return {Base::Shader, 0};
}

// ---- declarations

void Parser::read(const Preprocessed& text) {
    tokens_ = &text.tokens;
    annotations_ = text.annotations;
    at_ = 0;
    lastError_ = size_t(-1);
    unit_.incomplete |= text.incomplete;
    while (peek().kind != Tok::End && !sources_.tooMany()) {
        const size_t before = at_;
        try {
            topLevel();
        } catch (const SyntaxError&) {
            // On to something that can begin a definition: behind a closing brace, or at a word at the start of a line.
            while (peek().kind != Tok::End) {
                if (at("{")) {
                    skipBalanced();
                    break;
                }
                if (at_ != before && peek().lineStart && (atTypeName() || shaderKindNamed(peek().text)) &&
                    peek(1).kind == Tok::Identifier && peek(2).is("("))
                    break;
                take();
            }
            skippedFrom(before);
        }
        if (at_ == before) take();
    }
    // Those behind the last shader are its own.
    if (annotations_.empty()) return;
    if (Shader* s = lastShader()) takeAnnotations(*s);
}

/// The last shader or class of the texts so far; null if there is none.
Shader* Parser::lastShader() {
    const auto later = [](const Place& a, const Place& b) { return std::tie(a.line, a.column) > std::tie(b.line, b.column); };
    Shader* last = unit_.shaders.empty() ? nullptr : unit_.shaders.back().get();
    Shader* object = unit_.classes.empty() ? nullptr : unit_.classes.back().shader.get();
    return !last || (object && later(object->place, last->place)) ? object : last;
}

/// At the end of a shader: the annotations that stand in it, or before it and behind the one before, are its own.
void Parser::takeAnnotations(Shader& s) {
    while (!annotations_.empty() && (annotations_.front().token < at_ || peek().kind == Tok::End)) {
        s.annotations.emplace_back(annotations_.front().key, annotations_.front().value);
        annotations_ = annotations_.subspan(1);
    }
}

bool Parser::notYet(Place p, const char* what) {
    if (reported_.insert(what).second) sources_.report(p, msg::kNotAvailable(what));
    unit_.incomplete = true;
    return true;
}

void Parser::topLevel() {
    if (accept(";")) return;
    if (at("}")) {
        sources_.report(take().place, msg::kStrayBrace);
        return;
    }
    const Token& first = peek();
    if (first.kind == Tok::Identifier && peek(1).kind == Tok::Identifier) {
        if (auto kind = shaderKindNamed(first.text); kind && (peek(2).is("(") || peek(2).is("{"))) {
            take();
            return shader(*kind);
        }
        if (first.text == "struct" && (peek(2).is("{") || !structs_.count(std::string(peek(1).text)))) return structure();
        if (first.text == "class" && (peek(2).is("(") || peek(2).is("{"))) return shaderObject();
    }
    if (first.kind == Tok::Identifier && shaderKindNamed(first.text) && peek(1).kind == Tok::Identifier &&
        peek(2).kind == Tok::Identifier) {
        const std::string name(peek(1).text), next(peek(2).text);
        fail(peek(2).place, msg::kExpectedToken("'(' after the name of shader '" + name + "'", "'" + next + "'"));
    }
    if (plugin()) return;
    specifiers();
    const bool typed = atTypeName();
    Type type;
    if (typed) { type = dimensions(takeType()); }
    if (peek().kind != Tok::Identifier || !peek(1).is("(")) {
        std::vector<std::string> kinds = {"surface", "displacement", "light", "volume", "imager", "transformation"};
        const std::string near = nearestName(first.text, kinds);
        fail(peek().place, msg::kExpectedDefinition(shown()), near.empty() || typed ? "" : "did you mean '" + near + "'?");
    }
    auto f = function(type, typed);
    if (!f) return;
    // Defined again, as when a file is included twice, or when a shader has its own version of what a header gave: the last
    // counts.
    for (auto& old : unit_.functions) {
        bool same = old->name == f->name && old->result == f->result && old->parameters.size() == f->parameters.size();
        for (size_t i = 0; same && i < f->parameters.size(); ++i) same = old->parameters[i]->type == f->parameters[i]->type;
        if (!same) continue;
        if (old->place.file == f->place.file) sources_.report(f->place, msg::kFunctionRedefined(f->name));
        old = std::move(f);
        return;
    }
    unit_.functions.push_back(std::move(f));
}

bool Parser::plugin() {
    if (!at("plugin") || peek(1).kind != Tok::String) return false;
    const Place place = take().place;
    std::string name;
    while (peek().kind == Tok::String) name += stringValue(take().text);
    if (!accept(";") && !peek().lineStart) expectSemicolon("the name of a plug-in");
    unit_.plugins.push_back({std::move(name), place});
    return true;
}

void Parser::shader(ShaderKind kind) {
    auto s = std::make_unique<Shader>();
    s->kind = kind;
    s->place = peek().place;
    s->name = std::string(take().text);
    owner_ = {&s->symbols, &s->nested};
    typeWords_.clear();
    if (accept("(")) parameters(owner_, &s->parameters, nullptr);
    if (at(";") && peek(1).is("{")) sources_.report(take().place, msg::kStraySemicolon);
    if (!at("{")) failHere(msg::kExpectedToken("'{' of the body of shader '" + s->name + "'", shown()));
    s->body = block();
    owner_ = {};
    typeWords_.clear();
    takeAnnotations(*s);
    unit_.shaders.push_back(std::move(s));
}

} // namespace alpenglow::rsl::front

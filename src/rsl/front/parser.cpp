#include "rsl/front/parser.h"
#include "base/limits.h"
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
    if (at_ + 1 < tokens_.size()) ++at_;
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
    const Token& last = tokens_[at_ - 1];
    return {last.place.file, last.place.line, last.place.column + int(last.text.size())};
}

void Parser::fail(Place p, std::string message, std::string hint) {
    // One message for one place: what follows while we are still there is a consequence.
    if (lastError_ != at_ && !atCut()) sources_.error(p, std::move(message), std::move(hint));
    lastError_ = at_;
    throw SyntaxError{};
}

void Parser::failHere(const std::string& expected) {
    if (peek().kind == Tok::Invalid && peek().text.empty()) { // reported where it was made
        lastError_ = at_;
        throw SyntaxError{};
    }
    if (peek().kind == Tok::Invalid)
        fail(peek().place,
             peek().text[0] == '"' ? "this string does not end on its line" : "the character " + shown() + " means nothing here");
    fail(peek().place, expected + " before " + shown());
}

void Parser::expect(std::string_view s, const char* where) {
    if (!accept(s)) failHere("expected '" + std::string(s) + "' " + where);
}

void Parser::expectSemicolon(const char* after) {
    if (accept(";")) return;
    const bool newLine = peek().lineStart || at("}") || peek().kind == Tok::End;
    if (!newLine || peek().kind == Tok::Invalid) failHere(std::string("expected ';' after ") + after);
    // It was forgotten at the end of a line: say so there and go on as if it stood there.
    if (!atCut()) sources_.error(endOfLast(), std::string("expected ';' after ") + after);
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
        if (at("{")) { skipBalanced(); return; }
        if (take().is(";")) return;
    }
}

void Parser::skippedFrom(size_t begin) {
    for (size_t n = begin; n < at_ && n < tokens_.size(); ++n)
        if (tokens_[n].kind == Tok::Identifier) unit_.skipped.emplace(tokens_[n].text);
}

Parser::Depth::Depth(Parser& p) : parser(p) {
    if (++p.depth_ <= limits::kExpressionDepth) return;
    --p.depth_;
    const bool first = !p.tooDeep_;
    p.tooDeep_ = true;
    p.unit_.incomplete = true;
    const Place at = p.peek().place;
    p.at_ = p.tokens_.size() - 1; // no use in reading on
    if (first) p.sources_.error(at, "nested more than " + std::to_string(limits::kExpressionDepth) + " deep");
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

Base Parser::takeBase() {
    const std::string name(take().text);
    handle_ = name == "shader" && !structs_.count(name);
    if (const auto base = baseNamed(name)) return *base;
    if (const auto s = structs_.find(name); s != structs_.end()) return structBase(size_t(s->second));
    return Base::String; // a handle of a shader is its name
}

// ---- declarations

Unit Parser::parse() {
    while (peek().kind != Tok::End && !sources_.tooMany()) {
        const size_t before = at_;
        try {
            topLevel();
        } catch (const SyntaxError&) {
            // On to something that can begin a definition: behind a closing brace, or at a word at the start of a line.
            while (peek().kind != Tok::End) {
                if (at("{")) { skipBalanced(); break; }
                if (at_ != before && peek().lineStart && (atTypeName() || shaderKindNamed(peek().text)) &&
                    peek(1).kind == Tok::Identifier && peek(2).is("("))
                    break;
                take();
            }
            skippedFrom(before);
        }
        if (at_ == before) take();
    }
    return std::move(unit_);
}

bool Parser::notYet(Place p, const char* what) {
    if (told_.insert(what).second) sources_.error(p, std::string(what) + " are not yet available");
    unit_.incomplete = true;
    return true;
}

void Parser::topLevel() {
    if (accept(";")) return;
    if (at("}")) {
        sources_.warning(take().place, "this '}' closes nothing and is ignored");
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
    if (plugin()) return;
    const Specifiers s = specifiers();
    const bool typed = atTypeName();
    Type type;
    handle_ = false;
    if (typed) {
        type.base = takeBase();
        type = dimensions(type);
    }
    if (peek().kind != Tok::Identifier || !peek(1).is("(")) {
        std::vector<std::string> kinds = {"surface", "displacement", "light", "volume", "imager", "transformation"};
        const std::string near = nearestName(first.text, kinds);
        fail(peek().place, "expected a shader or a function before " + shown(),
             near.empty() || typed ? "" : "did you mean '" + near + "'?");
    }
    auto f = function(ofType(s), type, typed);
    if (!f) return;
    // Defined again, as when a file is included twice, or when a shader has its own version of what a header gave: the last counts.
    for (auto& old : unit_.functions) {
        bool same = old->name == f->name && old->result == f->result && old->parameters.size() == f->parameters.size();
        for (size_t i = 0; same && i < f->parameters.size(); ++i) same = old->parameters[i]->type == f->parameters[i]->type;
        if (!same) continue;
        if (old->place.file == f->place.file)
            sources_.warning(f->place, "function '" + f->name + "' is defined again; the last definition counts");
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
    if (at(";") && peek(1).is("{")) sources_.warning(take().place, "a ';' between a shader's parameters and its body is ignored");
    if (!at("{")) failHere("expected '{' of the body of shader '" + s->name + "'");
    s->body = block();
    owner_ = {};
    typeWords_.clear();
    unit_.shaders.push_back(std::move(s));
}

/// At the name. The body is read; a prototype without one gives nothing.
std::unique_ptr<Function> Parser::function(const Specifiers& s, Type type, bool typed) {
    auto f = std::make_unique<Function>();
    f->place = peek().place;
    f->name = std::string(take().text);
    f->result = type;
    f->handle = s.handle;
    const Owner outer = owner_;
    const bool outerReturns = returnsValue_;
    const auto outerWords = std::exchange(typeWords_, {});
    owner_ = {&f->symbols, &f->nested};
    returnsValue_ = false;
    try {
        expect("(", "after the name of a function");
        parameters(owner_, nullptr, &f->parameters);
        if (accept(";")) {
            owner_ = outer;
            typeWords_ = outerWords;
            returnsValue_ = outerReturns;
            return nullptr;
        }
        if (!at("{")) failHere("expected '{' of the body of function '" + f->name + "'");
        f->body = block();
    } catch (const SyntaxError&) {
        owner_ = outer;
        typeWords_ = outerWords;
        returnsValue_ = outerReturns;
        throw;
    }
    if (!typed && returnsValue_) f->result = {Base::Float, 0};
    owner_ = outer;
    typeWords_ = outerWords;
    returnsValue_ = outerReturns;
    return f;
}

namespace {
bool specifies(const Token& t) {
    for (const char* w : {"uniform", "varying", "output", "extern", "constant", "const", "public"})
        if (t.is(w)) return true;
    return false;
}
} // namespace

Parser::Specifiers Parser::specifiers() {
    Specifiers s;
    s.place = peek().place;
    for (;; s.any = true) {
        if (accept("output")) s.output = true;
        else if (accept("extern")) s.isExtern = true;
        else if (accept("uniform")) s.storage = Storage::Uniform;
        else if (accept("varying")) s.storage = Storage::Varying;
        else if (atStructWord()) take(); // "struct Name x", as in C
        // Words of later versions: only where a type or another specifier follows are they more than a name.
        else if ((at("constant") || at("const") || at("public")) &&
                 (atTypeName(1) || specifies(peek(1)))) {
            if (at("constant")) {
                s.storage = Storage::Uniform;
                s.isConstant = true;
            }
            take();
        } else return s;
    }
}

/// "[3]" or "[]", if there.
Type Parser::dimensions(Type type) {
    if (!at("[")) return type;
    const Place place = take().place;
    type.array = -1;
    if (!at("]")) type.array = constantLength(*expression(), place);
    expect("]", "after the length of an array");
    if (at("[")) fail(peek().place, "an array of arrays is not allowed");
    return type;
}

int Parser::constantLength(const Expr& e, Place place) {
    std::function<std::optional<double>(const Expr&)> value = [&](const Expr& x) -> std::optional<double> {
        if (x.kind == ExprKind::Number) return x.number;
        if (x.kind != ExprKind::Binary && !(x.kind == ExprKind::Unary && x.op == ExprOp::Negate)) return std::nullopt;
        const auto a = value(*x.args[0]);
        if (x.kind == ExprKind::Unary) return a ? std::optional(-*a) : a;
        const auto b = value(*x.args[1]);
        if (!a || !b) return std::nullopt;
        switch (x.op) {
        case ExprOp::Add: return *a + *b;
        case ExprOp::Sub: return *a - *b;
        case ExprOp::Mul: return *a * *b;
        case ExprOp::Div: return *b == 0 ? 0 : *a / *b;
        default: return std::nullopt;
        }
    };
    const auto n = value(e);
    if (n && *n >= 1 && *n <= limits::kShaderArray) return int(*n);
    if (!n) sources_.error(e.place, "the length of an array must be a constant number");
    else sources_.error(place, "the length of an array must be between 1 and " + std::to_string(limits::kShaderArray));
    return 1;
}

/// RSL 1 could name a space in a declaration: color "hsv" c = (0.1, 1, 1).
ExprPtr Parser::declaredSpace(Base base) {
    if (peek().kind != Tok::String || base == Base::String || base == Base::Float || base == Base::Void) return nullptr;
    return primary();
}

ExprPtr Parser::inSpace(ExprPtr value, Base base, const Expr* space) {
    if (!space || value->kind == ExprKind::ArrayList) return value;
    auto e = node(ExprKind::Cast, value->place);
    e->type.base = base;
    e->space = node(ExprKind::String, space->place);
    e->space->text = space->text;
    adopt(*e, std::move(value));
    return e;
}

Symbol* Parser::declare(Owner owner, const Token& name, Type type, const Specifiers& s) {
    auto symbol = std::make_unique<Symbol>();
    symbol->name = std::string(name.text);
    symbol->type = type;
    symbol->storage = s.storage;
    symbol->output = s.output;
    symbol->isExtern = s.isExtern;
    symbol->isConstant = s.isConstant;
    symbol->handle = s.handle;
    symbol->place = name.place;
    owner.symbols->push_back(std::move(symbol));
    return owner.symbols->back().get();
}

/// Behind the '(', up to and with the ')'. One of the two lists is filled.
void Parser::parameters(Owner owner, std::vector<ShaderParameter>* shader, std::vector<Symbol*>* function) {
    Specifiers group;
    std::optional<Base> base, before; // of this group, of the group before the last ';'
    ExprPtr space;
    while (!accept(")")) {
        if (peek().kind == Tok::End || at("{")) failHere("expected ')' after the parameters");
        try {
            if (at(";")) {
                take();
                if (base) before = base;
                base.reset();
                continue;
            }
            if (accept(",")) continue;
            const bool newGroup = atStructWord() || (atTypeName() && !(base && atName())) || at("output") || at("uniform") || at("varying") || at("extern") ||
                                  ((at("constant") || at("const") || at("public")) && (atTypeName(1) || specifies(peek(1))));
            if (newGroup) {
                group = specifiers();
                if (!atTypeName()) failHere("expected a type");
                base = takeBase();
                group.handle = handle_;
            }
            if (newGroup) space = declaredSpace(base.value_or(Base::Void));
            if (!base && before && *before != Base::Void && atName() && (peek(1).is("=") || peek(1).is(";") || peek(1).is(","))) {
                base = before;
                sources_.warning(peek().place, "parameter '" + std::string(peek().text) + "' has no type; it is taken for a " +
                                                   toString(Type{*base, 0}) + " like the one before");
            }
            if (!base) failHere("expected the type of a parameter");
            if (*base == Base::Void) {
                if (at(")")) continue; // (void), as in C
                sources_.error(peek().place, "a parameter cannot be void"); // calls with a value for it are no errors
            }
            Type type = dimensions({*base, 0});
            if (function && (at(",") || at(";") || at(")"))) { // of a prototype: the name may be missing
                function->push_back(declare(owner, peek(), type, group));
                continue;
            }
            if (!atName()) failHere("expected the name of a parameter");
            const Token& name = takeName();
            type = dimensions(type);
            Symbol* symbol = declare(owner, name, type, group);
            symbol->origin = shader ? Symbol::Origin::ShaderParameter : Symbol::Origin::FunctionParameter;
            if (function) function->push_back(symbol);
            else shader->push_back({symbol, nullptr});
            if (accept("=")) {
                ExprPtr value = inSpace(at("{") ? arrayList() : assignment(), *base, space.get());
                if (shader) shader->back().defaultValue = std::move(value);
                else sources_.warning(value->place, "parameters of functions have no default values; this one is ignored");
            } else if (shader && !symbol->output && !isStruct(type) && type.base != Base::Void && symbol->type.array >= 0) {
                sources_.warning(symbol->place, "parameter '" + symbol->name + "' has no default value; it is zero unless set");
            }
            if (at(")") || at(";") || at(",")) continue;
            if (atTypeName() || at("uniform") || at("varying") || at("output"))
                sources_.warning(endOfLast(), "expected ';' before the next parameter; read as if it stood here");
            else failHere("expected ';', ',' or ')' after a parameter");
        } catch (const SyntaxError&) {
            if (tooDeep_) throw;
            const size_t begin = at_ > 2 ? at_ - 2 : 0; // the parameter's own name, too
            for (; peek().kind != Tok::End && !at(";") && !at(")") && !at("{");) {
                if (at("(") || at("[")) skipBalanced();
                else take();
            }
            skippedFrom(begin);
        }
    }
}

/// At "name (": is it the definition of a function, not a call behind a cast?
bool Parser::functionFollows() const {
    if (peek().kind != Tok::Identifier || !peek(1).is("(")) return false;
    if (peek(2).is(")")) return peek(3).is("{");
    if (peek(2).is("uniform") || peek(2).is("varying") || peek(2).is("output")) return true;
    if (atTypeName(2) && (peek(3).is(")") || peek(3).is(",") || peek(3).is(";"))) return true; // a parameter without a name
    return atTypeName(2) && (peek(3).kind == Tok::Identifier || peek(3).is("[")) && !peek(4).is("(");
}

} // namespace alpenglow::rsl::front

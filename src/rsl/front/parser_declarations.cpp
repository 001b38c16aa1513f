// Functions, parameters, and what declarations are made of.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/parser.h"
#include <utility>

namespace alpenglow::rsl::front {

/// At the name. Null for a prototype, which has no body.
std::unique_ptr<Function> Parser::function(Type type, bool typed) {
    auto f = std::make_unique<Function>();
    f->place = peek().place;
    f->name = std::string(take().text);
    f->result = type;
    const Owner outer = owner_;
    const bool outerReturns = returnsValue_;
    const auto outerWords = std::exchange(typeWords_, {});
    owner_ = {&f->symbols, &f->nested};
    returnsValue_ = false;
    try {
        expect("(", "after the name of a function");
        parameters(owner_, nullptr, &f->parameters, &f->defaults);
        if (accept(";")) {
            owner_ = outer;
            typeWords_ = outerWords;
            returnsValue_ = outerReturns;
            return nullptr;
        }
        if (!at("{")) failHere(msg::kExpectedToken("'{' of the body of function '" + f->name + "'", shown()));
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
        else if ((at("constant") || at("const") || at("public")) && (atTypeName(1) || specifies(peek(1)))) {
            if (at("constant")) {
                s.storage = Storage::Uniform;
                s.isConstant = true;
            }
            take();
        } else return s;
    }
}

/// "[3]" or "[]", if there. With `length`, one that is known only when the shader runs goes there, and the array is open.
Type Parser::dimensions(Type type, ExprPtr* length) {
    if (!at("[")) return type;
    const Place place = take().place;
    type.array = -1;
    if (!at("]")) {
        auto e = expression();
        type.array = constantLength(*e, place, length != nullptr);
        if (type.array < 0) *length = std::move(e);
    }
    expect("]", "after the length of an array");
    if (at("[")) fail(peek().place, msg::kArrayOfArrays);
    return type;
}

int Parser::constantLength(const Expr& e, Place place, bool open) {
    std::function<std::optional<double>(const Expr&)> value = [&](const Expr& x) -> std::optional<double> {
        if (x.kind == ExprKind::Number) return x.number;
        if (x.kind != ExprKind::Binary && !(x.kind == ExprKind::Unary && x.op == ExprOp::Negate)) return std::nullopt;
        const auto a = value(*x.args[0]);
        if (x.kind == ExprKind::Unary) return a ? std::optional(-*a) : a;
        const auto b = value(*x.args[1]);
        if (!a || !b) return std::nullopt;
        switch (x.op) {
        case ExprOp::Add:
            return *a + *b;
        case ExprOp::Sub:
            return *a - *b;
        case ExprOp::Mul:
            return *a * *b;
        case ExprOp::Div:
            return *b == 0 ? 0 : *a / *b;
        default:
            return std::nullopt;
        }
    };
    const auto n = value(e);
    if (n && *n >= 1 && *n <= limits::kShaderArray) return int(*n);
    if (!n && open) return -1;
    if (!n) sources_.report(e.place, msg::kArrayLengthConstant);
    else sources_.report(place, msg::kArrayLengthRange(limits::kShaderArray));
    return 1;
}

/// RSL 1 could name a space in a declaration: color "hsv" c = (0.1, 1, 1).
ExprPtr Parser::declaredSpace(Type type) {
    const Base base = type.base;
    if (peek().kind != Tok::String || isStringLike(base) || base == Base::Float || base == Base::Void) return nullptr;
    return primary();
}

ExprPtr Parser::inSpace(ExprPtr value, Type type, const Expr* space) {
    if (!space) return value;
    if (value->kind == ExprKind::ArrayList) { // each element is in that space
        for (ExprPtr& a : value->args) {
            a = inSpace(std::move(a), type, space);
            grow(*value, *a);
        }
        return value;
    }
    auto e = node(ExprKind::Cast, value->place);
    e->type = type.element();
    e->space = clone(*space);
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
    symbol->place = name.place;
    owner.symbols->push_back(std::move(symbol));
    return owner.symbols->back().get();
}

/// Behind the '(', up to and with the ')'. One of the two lists is filled.
void Parser::parameters(Owner owner, std::vector<ShaderParameter>* shader, std::vector<Symbol*>* function,
                        std::vector<ExprPtr>* defaults) {
    Specifiers group;
    std::optional<Type> base, before; // of this group, of the group before the last ';'
    ExprPtr space;
    while (!accept(")")) {
        if (peek().kind == Tok::End || at("{")) failHere(msg::kExpectedToken("')' after the parameters", shown()));
        try {
            if (at(";")) {
                take();
                if (base) before = base;
                base.reset();
                continue;
            }
            if (accept(",")) continue;
            const bool newGroup = atStructWord() || (atTypeName() && !(base && atName())) || at("output") || at("uniform") ||
                                  at("varying") || at("extern") ||
                                  ((at("constant") || at("const") || at("public")) && (atTypeName(1) || specifies(peek(1))));
            if (newGroup) {
                group = specifiers();
                if (!atTypeName()) failHere(msg::kExpectedType(shown()));
                base = takeType();
            }
            if (newGroup) space = declaredSpace(base.value_or(Type{}));
            if (!base && before && before->base != Base::Void && atName() &&
                (peek(1).is("=") || peek(1).is(";") || peek(1).is(","))) {
                base = before;
                sources_.report(peek().place, msg::kUntypedParameter(peek().text, toString(*base)));
            }
            if (!base) failHere(msg::kExpectedParameterType(shown()));
            if (base->base == Base::Void) {
                if (at(")")) continue;                              // (void), as in C
                sources_.report(peek().place, msg::kVoidParameter); // calls with a value for it are no errors
            }
            Type type = dimensions(*base);
            if (function && (at(",") || at(";") || at(")"))) { // of a prototype: the name may be missing
                function->push_back(declare(owner, peek(), type, group));
                continue;
            }
            if (!atName()) failHere(msg::kExpectedName("a parameter", shown()));
            const Token& name = takeName();
            type = dimensions(type);
            Symbol* symbol = declare(owner, name, type, group);
            symbol->origin = shader ? Symbol::Origin::ShaderParameter : Symbol::Origin::FunctionParameter;
            if (function) function->push_back(symbol);
            else shader->push_back({symbol, nullptr});
            if (accept("=")) {
                const size_t begin = at_;
                ExprPtr value = inSpace(at("{") ? arrayList() : assignment(), *base, space.get());
                if (shader) {
                    shader->back().defaultValue = std::move(value);
                    if (space) shader->back().defaultText = "\"" + space->text + "\" ";
                    shader->back().defaultText += written(begin);
                } else if (defaults && inObject_ && !isStruct(type)) {
                    defaults->resize(function->size());
                    defaults->back() = std::move(value);
                } else sources_.report(value->place, msg::kFunctionDefault);
            } else if (shader && !symbol->output && !isStruct(type) && type.base != Base::Void && symbol->type.array >= 0) {
                const char* what = !isStringLike(type.base) ? "zero" : type.base == Base::Shader ? "null" : "empty";
                sources_.report(symbol->place, msg::kNoDefault(symbol->name, what));
            }
            if (at(")") || at(";") || at(",")) continue;
            if (atTypeName() || at("uniform") || at("varying") || at("output"))
                sources_.report(endOfLast(), msg::kExpectedSemicolonParameter);
            else failHere(msg::kExpectedToken("';', ',' or ')' after a parameter", shown()));
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

/// The tokens from there to here as one line.
std::string Parser::written(size_t begin) const {
    std::string s;
    for (size_t i = begin; i < at_ && i < tokens_->size(); ++i) {
        const Token& t = (*tokens_)[i];
        if (i > begin && (t.space || t.lineStart)) s += ' ';
        s += t.text;
    }
    return s;
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

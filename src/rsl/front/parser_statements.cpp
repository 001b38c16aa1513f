#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/parser.h"

namespace alpenglow::rsl::front {

StmtPtr Parser::make(StmtKind kind, Place place) {
    auto s = std::make_unique<Stmt>();
    s->kind = kind;
    s->place = place;
    return s;
}

StmtPtr Parser::expressionStatement(ExprPtr e) {
    auto s = make(StmtKind::Expression, e->place);
    s->value = std::move(e);
    return s;
}

StmtPtr Parser::block() {
    auto b = make(StmtKind::Block, peek().place);
    expect("{", "");
    statements(*b);
    if (!accept("}")) {
        if (lastError_ != at_ && !atCut())
            sources_.report(peek().place, msg::kExpectedBrace, "the block began at line " + std::to_string(b->place.line));
        lastError_ = at_;
        unit_.incomplete = true;
    }
    return b;
}

void Parser::statements(Stmt& block) {
    while (!at("}") && peek().kind != Tok::End && !sources_.tooMany()) {
        const size_t before = at_;
        try {
            if (auto s = statement()) block.body.push_back(std::move(s));
            for (auto& s : after_) block.body.push_back(std::move(s));
            after_.clear();
        } catch (const SyntaxError&) {
            recover();
            skippedFrom(before);
        }
        if (at_ == before && !at("}")) take();
    }
}

StmtPtr Parser::statement() {
    Depth depth(*this);
    return statementOnce();
}

/// `if` or `while`.
StmtPtr Parser::conditional(StmtKind kind) {
    auto s = make(kind, peek().place);
    const std::string word(take().text);
    expect("(", ("after '" + word + "'").c_str());
    s->condition = expression();
    expect(")", "after the condition");
    s->body.push_back(statement());
    if (kind == StmtKind::If && accept("else")) s->elseBody = statement();
    return s;
}

/// `break` or `continue`, with the number of loops.
StmtPtr Parser::jump(StmtKind kind) {
    auto s = make(kind, take().place);
    if (peek().kind == Tok::Number) {
        const auto n = primary();
        if (n->number >= 1 && n->number <= 1000 && n->number == int(n->number)) s->levels = int(n->number);
        else sources_.report(n->place, msg::kLoopLevels);
    }
    expectSemicolon(kind == StmtKind::Break ? "break" : "continue");
    return s;
}

StmtPtr Parser::returnStatement() {
    auto s = make(StmtKind::Return, take().place);
    if (!at(";") && !at("}")) {
        s->value = expression();
        returnsValue_ = true;
    }
    expectSemicolon("return");
    return s;
}

/// At a word: a declaration rather than a call, a conversion or an expression?
bool Parser::atDeclaration() {
    const std::string_view w = peek().text;
    if (atStructWord() || w == "uniform" || w == "varying" || w == "extern" || w == "output") return true;
    if ((w == "constant" || w == "const" || w == "public") && (atTypeName(1) || peek(1).is("uniform") || peek(1).is("varying")))
        return true;
    if (!atTypeName()) return false;
    const Token& n = peek(1);
    if (n.is("[") || n.is("=") || n.is(";") || n.is(",") || w == "void") return true;
    const bool spaced = n.kind == Tok::String && peek(2).kind == Tok::Identifier && w != "string" &&
                        (peek(3).is("=") || peek(3).is(";") || peek(3).is(",") || peek(3).is("["));
    if (spaced) return true;
    ++at_;
    const bool name = atName();
    const bool definition = name && (!peek(1).is("(") || functionFollows());
    --at_;
    return definition;
}

/// "vectr x = ..." reads as two names in a row: most likely a type with a slip.
void Parser::refuseTypeName() {
    const Token& t = peek();
    const bool two = peek(1).kind == Tok::Identifier && !peek(1).lineStart &&
                     (peek(2).is("=") || peek(2).is(";") || peek(2).is(",") || peek(2).is("["));
    if (!two) return;
    const std::string_view w = t.text;
    const std::string near =
        nearestName(w, {"float", "color", "point", "vector", "normal", "matrix", "string", "uniform", "varying"});
    fail(t.place, msg::kNotAType(w),
         near.empty() ? (w == "int" || w == "bool" ? "use float" : "") : "did you mean '" + near + "'?");
}

/// Parses a statement that begins with a keyword. Returns null, and consumes nothing, if the next token is none.
StmtPtr Parser::keywordStatement() {
    const std::string_view w = peek().text;
    if (w == "if") return conditional(StmtKind::If);
    if (w == "else") fail(peek().place, msg::kStrayElse);
    if (w == "while") return conditional(StmtKind::While);
    if (w == "for") return forLoop();
    if (w == "do" && (peek(1).is("{") || (peek(1).kind == Tok::Identifier && !peek(1).lineStart))) return doLoop();
    if (w == "break") return jump(StmtKind::Break);
    if (w == "continue") return jump(StmtKind::Continue);
    if (w == "return") return returnStatement();
    if (!peek(1).is("(")) return nullptr;
    if (w == "illuminance") return lightStatement(StmtKind::Illuminance);
    if (w == "illuminate") return lightStatement(StmtKind::Illuminate);
    if (w == "solar") return lightStatement(StmtKind::Solar);
    if (w == "gather") return lightStatement(StmtKind::Gather);
    return nullptr;
}

StmtPtr Parser::statementOnce() {
    const Token& t = peek();
    if (t.is("{")) return block();
    if (t.is(";")) return make(StmtKind::Block, take().place);
    if (t.kind != Tok::Identifier) return effects();
    if (t.text == "plugin") {
        const Place place = t.place;
        if (plugin()) return make(StmtKind::Block, place);
    }
    if (auto s = keywordStatement()) return s;
    if (atDeclaration()) return declaration();
    if (peek().text == "struct" && peek(1).kind == Tok::Identifier && peek(2).is("{")) {
        structure();
        return nullptr;
    }
    refuseTypeName();
    return effects();
}

/// One expression for its effect, or several with commas between.
StmtPtr Parser::effects() {
    auto s = expressionStatement(effect());
    if (at(",")) {
        sources_.report(peek().place, msg::kCommaStatements);
        auto all = make(StmtKind::Block, s->place);
        all->body.push_back(std::move(s));
        while (accept(",")) all->body.push_back(expressionStatement(effect()));
        s = std::move(all);
    }
    expectSemicolon("an expression");
    return s;
}

StmtPtr Parser::declaration(bool member) {
    auto s = make(StmtKind::Declare, peek().place);
    Specifiers spec = specifiers();
    if (!atTypeName()) failHere(msg::kExpectedType(shown()));
    Type type = takeType();
    const ExprPtr space = declaredSpace(type);
    ExprPtr shared;
    type = dimensions(type, member ? nullptr : &shared);
    if (functionFollows() || (type.base == Base::Void && peek(1).is("("))) {
        auto f = function(type, true);
        if (!f) return nullptr;
        s->definition = f.get();
        owner_.nested->push_back(std::move(f));
        return s;
    }
    if (type.base == Base::Void) fail(s->place, msg::kVoidVariable);
    do {
        if (!atName()) failHere(msg::kExpectedName("a variable", shown()));
        const Token& name = takeName();
        ExprPtr length;
        const Type own = dimensions(type, member ? nullptr : &length);
        if (!length && shared) length = clone(*shared);
        Symbol* symbol = declare(owner_, name, own, spec);
        s->declarators.push_back({symbol, nullptr});
        if (length && !spec.isExtern) { // float x[n]: an open array, then resize()
            auto e = node(ExprKind::ShadeopCall, length->place);
            e->text = "resize";
            adopt(*e, variable(symbol->name, length->place));
            adopt(*e, std::move(length));
            after_.push_back(front::run(std::move(e)));
        }
        if (accept("=")) {
            if (spec.isExtern) sources_.report(name.place, msg::kExternValue);
            try {
                s->declarators.back().init = inSpace(at("{") ? arrayList() : assignment(), type.element(), space.get());
            } catch (const SyntaxError&) {
                // The name is declared all the same: its uses are no errors.
                if (tooDeep_) throw;
                const size_t begin = at_;
                recover();
                skippedFrom(begin);
                return s;
            }
        }
    } while (accept(","));
    expectSemicolon("a declaration");
    return s;
}

StmtPtr Parser::forLoop() {
    const Place place = take().place;
    if (!accept("(")) {
        if (peek().kind == Tok::End || at("{")) failHere(msg::kExpectedToken("'(' after 'for'", shown()));
        sources_.report(peek().place, msg::kExpectedToken("'(' after 'for'", shown())); // and on as if it stood there
    }
    auto outer = make(StmtKind::Block, place);
    auto loop = make(StmtKind::For, place);
    if (atTypeName() || at("uniform") || at("varying")) {
        outer->body.push_back(declaration()); // takes the ';'
    } else {
        while (!at(";")) {
            auto e = effect();
            if (accept(",")) outer->body.push_back(expressionStatement(std::move(e)));
            else {
                loop->init = std::move(e);
                break;
            }
        }
        expectSeparator("the start of 'for'");
    }
    if (!at(";")) loop->condition = expression();
    expectSeparator("the condition of 'for'");
    while (!at(")")) {
        auto step = effect();
        if (loop->step) { // several, one after the other
            auto all = node(ExprKind::Sequence, step->place);
            adopt(*all, std::move(loop->step));
            adopt(*all, std::move(step));
            step = std::move(all);
        }
        loop->step = std::move(step);
        if (!accept(",")) break;
    }
    expect(")", "after the step of 'for'");
    auto body = statement();
    if (!body) body = make(StmtKind::Block, place);
    loop->body.push_back(std::move(body));
    if (outer->body.empty()) return loop;
    outer->body.push_back(std::move(loop));
    return outer;
}

/// do s while (c);  is  first = 1; while (first ? 1 : c) { first = 0; s }
StmtPtr Parser::doLoop() {
    const Place place = peek().place;
    const Token& word = take();
    auto outer = make(StmtKind::Block, place);
    Symbol* first = declare(owner_, word, {Base::Float, 0}, {}); // "do": no variable of the shader can have that name
    const auto number = [&](double v) {
        auto e = node(ExprKind::Number, place);
        e->number = v;
        return e;
    };
    const auto variable = [&] {
        auto e = node(ExprKind::Variable, place);
        e->text = first->name;
        return e;
    };
    auto d = make(StmtKind::Declare, place);
    d->declarators.push_back({first, number(1)});
    outer->body.push_back(std::move(d));
    auto loop = make(StmtKind::While, place);
    auto body = make(StmtKind::Block, place);
    auto clear = node(ExprKind::Assign, place, ExprOp::Assign);
    adopt(*clear, variable());
    adopt(*clear, number(0));
    body->body.push_back(expressionStatement(std::move(clear)));
    if (auto s = statement()) body->body.push_back(std::move(s));
    loop->body.push_back(std::move(body));
    expect("while", "after the body of 'do'");
    expect("(", "after 'while'");
    auto choose = node(ExprKind::Conditional, place);
    adopt(*choose, variable());
    adopt(*choose, number(1));
    adopt(*choose, expression());
    loop->condition = std::move(choose);
    expect(")", "after the condition");
    expectSemicolon("'do'");
    outer->body.push_back(std::move(loop));
    return outer;
}

StmtPtr Parser::lightStatement(StmtKind kind) {
    auto s = make(kind, take().place);
    expect("(", "");
    arguments(s->exprs); // the checker separates category, positions and pairs
    s->body.push_back(statement());
    if (!s->body[0]) s->body[0] = make(StmtKind::Block, s->place);
    if (kind == StmtKind::Gather && accept("else")) s->elseBody = statement();
    return s;
}

} // namespace alpenglow::rsl::front

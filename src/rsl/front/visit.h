// The walk over a syntax tree, before it is checked, checked, or with errors in it. Passes that need an order of their own, or
// change what they meet, go down by eachSlot(), eachPart() and eachBody(); all others by the every...() functions.
#pragma once
#include "rsl/front/ast.h"
#include <type_traits>

namespace alpenglow::rsl::front {

/// Calls f(ExprPtr&), of a const expression f(const ExprPtr&), for the direct parts of an expression, in the order in which they
/// stand. Parts that are missing are left out.
template <class E, class F>
    requires std::is_same_v<std::remove_const_t<E>, Expr>
void eachSlot(E& e, F&& f) {
    const auto one = [&](auto& x) {
        if (x) f(x);
    };
    one(e.space);
    for (auto& a : e.args) one(a);
    one(e.channel);
    for (auto& p : e.pairs) one(p.value);
}

/// The same for the expressions of a statement, without those of statements below it.
template <class S, class F>
    requires std::is_same_v<std::remove_const_t<S>, Stmt>
void eachSlot(S& s, F&& f) {
    const auto one = [&](auto& x) {
        if (x) f(x);
    };
    for (auto& d : s.declarators) one(d.init);
    one(s.init), one(s.condition), one(s.step), one(s.value), one(s.category);
    for (auto& e : s.exprs) one(e);
    for (auto& p : s.pairs) one(p.value);
}

/// Calls f(const Expr&) for the direct parts of an expression or statement.
template <class Node, class F> void eachPart(const Node& n, F&& f) {
    eachSlot(n, [&](const ExprPtr& x) { f(*x); });
}

/// Calls f(StmtPtr&), of a const statement f(const StmtPtr&), for the statements directly below a statement: its body, then what
/// is behind `else`. Nested functions are not entered.
template <class S, class F> void eachBody(S& s, F&& f) {
    for (auto& b : s.body)
        if (b) f(b);
    if (s.elseBody) f(s.elseBody);
}

/// Calls f(const Expr&) for the expression and everything below it.
template <class F> void everyExpr(const Expr& e, F&& f) {
    f(e);
    eachPart(e, [&](const Expr& x) { everyExpr(x, f); });
}

/// Calls statement(const Stmt&) for the statement and all below it, and expression(const Expr&) for every expression in them, in
/// the order of the text. Nested functions are not entered.
template <class S, class F> void everyStmt(const Stmt& s, S&& statement, F&& expression) {
    statement(s);
    eachPart(s, [&](const Expr& e) { everyExpr(e, expression); });
    eachBody(s, [&](const StmtPtr& b) { everyStmt(*b, statement, expression); });
}
/// Calls f(const Expr&) for every expression of the statement and those below it.
template <class F> void everyExpr(const Stmt& s, F&& f) {
    everyStmt(s, [](const Stmt&) {}, f);
}

/// Calls f(const Function&) for every function of the program and those nested in functions and shaders.
template <class F> void everyFunction(const Function& g, F&& f) {
    f(g);
    for (const auto& n : g.nested)
        if (n) everyFunction(*n, f);
}
template <class F> void everyFunction(const Shader& s, F&& f) {
    for (const auto& n : s.nested)
        if (n) everyFunction(*n, f);
}
template <class F> void everyFunction(const Program& p, F&& f) {
    for (const auto& g : p.functions)
        if (g) everyFunction(*g, f);
    for (const auto& s : p.shaders) everyFunction(*s, f);
}

/// Calls f(const Stmt&) for the body of every function of a function, a shader or a program.
template <class Owner, class F> void everyFunctionBody(const Owner& o, F&& f) {
    everyFunction(o, [&](const Function& g) {
        if (g.body) f(*g.body);
    });
}

/// Calls f(const Stmt&) for the body of a shader and those of the functions in it.
template <class F> void everyBody(const Shader& s, F&& f) {
    if (s.body) f(*s.body);
    everyFunctionBody(s, f);
}

/// Calls f(const Stmt&) for the bodies of all shaders of a program, then for those of its functions.
template <class F> void everyBody(const Program& p, F&& f) {
    for (const auto& s : p.shaders)
        if (s->body) f(*s->body);
    everyFunctionBody(p, f);
}

} // namespace alpenglow::rsl::front

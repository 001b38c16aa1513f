// Over a checked tree, also one with errors in it: what hangs below a node.
#pragma once
#include "rsl/front/ast.h"

namespace alpenglow::rsl::front {

/// Calls f(const Expr&) for the direct parts of an expression, in the order in which they stand.
template <class F> void eachPart(const Expr& e, F&& f) {
    if (e.space) f(*e.space);
    for (const auto& a : e.args)
        if (a) f(*a);
    if (e.channel) f(*e.channel);
    for (const NamedArg& p : e.pairs)
        if (p.value) f(*p.value);
}

/// Calls f(const Expr&) for the expression and everything below it.
template <class F> void everyExpr(const Expr& e, F&& f) {
    f(e);
    eachPart(e, [&](const Expr& x) { everyExpr(x, f); });
}

/// Calls statement(const Stmt&) for the statement and all below it, and expression(const Expr&) for every expression in them.
/// Nested functions are not entered.
template <class S, class F> void everyStmt(const Stmt& s, S&& statement, F&& expression) {
    statement(s);
    const auto one = [&](const ExprPtr& e) {
        if (e) everyExpr(*e, expression);
    };
    for (const auto& d : s.declarators) one(d.init);
    one(s.init), one(s.condition), one(s.step), one(s.value), one(s.category);
    for (const auto& e : s.exprs) one(e);
    for (const NamedArg& p : s.pairs) one(p.value);
    for (const auto& b : s.body)
        if (b) everyStmt(*b, statement, expression);
    if (s.elseBody) everyStmt(*s.elseBody, statement, expression);
}

/// Calls f(const Function&) for every function of the program and those nested in functions and shaders.
template <class F> void everyFunction(const Function& g, F&& f) {
    f(g);
    for (const auto& n : g.nested)
        if (n) everyFunction(*n, f);
}
template <class F> void everyFunction(const Program& p, F&& f) {
    for (const auto& g : p.functions)
        if (g) everyFunction(*g, f);
    for (const auto& s : p.shaders)
        for (const auto& n : s->nested)
            if (n) everyFunction(*n, f);
}

} // namespace alpenglow::rsl::front

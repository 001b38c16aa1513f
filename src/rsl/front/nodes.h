// Pieces of a program as passes over the tree write them, before it is checked.
#pragma once
#include "rsl/front/ast.h"
#include <algorithm>
#include <memory>
#include <string>

namespace alpenglow::rsl::front {

/// An expression without operands.
inline ExprPtr node(ExprKind kind, Place place, ExprOp op = ExprOp::None) {
    auto e = std::make_unique<Expr>();
    e->kind = kind;
    e->place = place;
    e->op = op;
    return e;
}

/// Appends an operand and keeps the height of the tree.
inline void adopt(Expr& parent, ExprPtr child) {
    parent.height = std::max(parent.height, child->height + 1);
    parent.args.push_back(std::move(child));
}

/// The use of a variable by its name, before checking.
inline ExprPtr variable(const std::string& name, Place place) {
    auto e = node(ExprKind::Variable, place);
    e->text = name;
    return e;
}

/// A statement without contents.
inline StmtPtr make(StmtKind kind, Place place) {
    auto s = std::make_unique<Stmt>();
    s->kind = kind;
    s->place = place;
    return s;
}

/// The statement that evaluates an expression.
inline StmtPtr run(ExprPtr e) {
    auto s = make(StmtKind::Expression, e->place);
    s->value = std::move(e);
    return s;
}

} // namespace alpenglow::rsl::front

#include "rsl/front/conversions.h"
#include "rsl/front/ast.h"

namespace alpenglow::rsl::front {

bool isPointLike(Base b) { return b == Base::Point || b == Base::Vector || b == Base::Normal; }
static bool tuple(Base b) { return b == Base::Color || isPointLike(b); }

int implicitCost(Base from, Base to) {
    if (from == to) return 0;
    if (isPointLike(from) && isPointLike(to)) return kConversion;
    if (from == Base::Float && tuple(to)) return kBroadcast;
    if (from == Base::Float && to == Base::Matrix) return kBroadcast + 4 * kConversion;
    if (from == Base::Bool && to == Base::Float) return 4 * kConversion;
    if (from == Base::Bool && tuple(to)) return 2 * kBroadcast;
    return kNever;
}

int castCost(Base from, Base to) {
    const int c = implicitCost(from, to);
    if (c < kNever) return c;
    if (tuple(from) && tuple(to)) return 3 * kBroadcast; // color and point-like: only when written
    return kNever;
}

int conditionCost(Base from) {
    if (from == Base::Bool) return 0;
    if (from == Base::Float) return kConversion;
    return tuple(from) ? 4 * kConversion : kNever;
}

std::optional<Operation> operation(ExprOp op, Base l, Base r) {
    if (op == ExprOp::And || op == ExprOp::Or) {
        const int c = conditionCost(l) + conditionCost(r);
        if (c >= kNever) return std::nullopt;
        return Operation{Base::Bool, Base::Bool, c};
    }
    const bool relation = op == ExprOp::Less || op == ExprOp::LessEqual || op == ExprOp::Greater || op == ExprOp::GreaterEqual ||
                          op == ExprOp::Equal || op == ExprOp::NotEqual;
    int cost = 0;
    if (l == Base::Bool) {
        l = Base::Float;
        cost += 4 * kConversion;
    }
    if (r == Base::Bool) {
        r = Base::Float;
        cost += 4 * kConversion;
    }
    if (isStringLike(l) || isStringLike(r)) { // handles are compared with handles, and not joined
        const bool joins = op == ExprOp::Add && l == Base::String;
        if (l != r || (op != ExprOp::Equal && op != ExprOp::NotEqual && !joins)) return std::nullopt;
        return Operation{l, joins ? Base::String : Base::Bool, cost};
    }
    if (l == Base::Void || r == Base::Void) return std::nullopt;
    if (l == Base::Matrix || r == Base::Matrix) {
        const bool fits = (l == Base::Matrix || l == Base::Float) && (r == Base::Matrix || r == Base::Float);
        if (fits && (op == ExprOp::Equal || op == ExprOp::NotEqual))
            return Operation{Base::Matrix, Base::Bool, cost + (l != r ? 4 * kConversion : 0)};
        if (!fits || (op != ExprOp::Mul && op != ExprOp::Div)) return std::nullopt;
        return Operation{Base::Matrix, Base::Matrix, cost + (l != r ? 4 * kConversion : 0)};
    }
    if (op == ExprOp::Cross) {
        if (!isPointLike(l) || !isPointLike(r)) return std::nullopt;
        return Operation{Base::Vector, Base::Vector, cost};
    }
    if (op == ExprOp::Dot) {
        if (!tuple(l) || !tuple(r) || (l == Base::Color) != (r == Base::Color)) return std::nullopt;
        return Operation{l == r ? l : Base::Vector, Base::Float, cost};
    }
    Base common;
    bool promoted = false;
    if (l == r) common = l;
    else if (l == Base::Float || r == Base::Float) {
        common = l == Base::Float ? r : l;
        promoted = true;
    } else if (isPointLike(l) && isPointLike(r)) common = l == Base::Point || r == Base::Point ? Base::Point : Base::Vector;
    else return std::nullopt;
    Base result = relation ? Base::Bool : common;
    // The difference of two positions is a direction.
    if (op == ExprOp::Sub && common == Base::Point && l == r && !promoted) result = Base::Vector;
    return Operation{common, result, cost, promoted};
}

const char* spelling(ExprOp op) {
    static constexpr const char* kText[] = {
        "", "+", "-", "*", "/", ".", "^", "<", "<=", ">", ">=", "==", "!=", "&&", "||", "-", "!", "="};
    return kText[int(op)];
}

} // namespace alpenglow::rsl::front

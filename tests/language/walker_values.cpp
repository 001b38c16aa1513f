#include "walker_values.h"
#include <stdexcept>

namespace alpenglow::rsl::walking {

void unknown(const std::string& what) { throw std::runtime_error("the walker does not know " + what); }

int width(Base b) { return b == Base::Matrix ? 16 : b == Base::String ? 0 : b >= Base::Color ? 3 : 1; }

Walked number(float x) {
    Walked w;
    w.n[0] = x;
    return w;
}

Walked truth(bool b) {
    Walked w = number(b ? 1.0f : 0.0f);
    w.base = Base::Bool;
    return w;
}

Walked zero(Base b) {
    Walked w;
    w.base = b;
    return w;
}

Walked converted(const Walked& v, Base to) {
    Walked w = zero(to);
    w.s = v.s;
    const bool single = v.base == Base::Float || v.base == Base::Bool;
    if (!single || width(to) == 1) {
        if (!single && to == Base::Bool) unknown("a tuple as a truth value");
        w.n = v.n;
    } else {
        for (int c = 0; c < width(to); c++)
            if (to != Base::Matrix || c % 5 == 0) w.n[size_t(c)] = v.n[0];
    }
    return w;
}

namespace {

float divided(float a, float b) { return b == 0 ? 0 : a / b; }

Walked component(ExprOp op, const Walked& a, const Walked& b) {
    Walked r = zero(a.base);
    for (size_t c = 0; c < size_t(width(a.base)); c++)
        r.n[c] = op == ExprOp::Add   ? a.n[c] + b.n[c]
                 : op == ExprOp::Sub ? a.n[c] - b.n[c]
                 : op == ExprOp::Mul ? a.n[c] * b.n[c]
                                     : divided(a.n[c], b.n[c]);
    return r;
}

bool compare(ExprOp op, float a, float b) {
    switch (op) {
    case ExprOp::Less:
        return a < b;
    case ExprOp::LessEqual:
        return a <= b;
    case ExprOp::Greater:
        return a > b;
    case ExprOp::GreaterEqual:
        return a >= b;
    case ExprOp::Equal:
        return a == b;
    default:
        return a != b;
    }
}

} // namespace

Walked binary(ExprOp op, const Walked& a, const Walked& b) {
    switch (op) {
    case ExprOp::And:
        return truth(a.n[0] != 0 && b.n[0] != 0);
    case ExprOp::Or:
        return truth(a.n[0] != 0 || b.n[0] != 0);
    case ExprOp::Dot:
        return number(a.n[0] * b.n[0] + a.n[1] * b.n[1] + a.n[2] * b.n[2]);
    case ExprOp::Cross: {
        Walked r = zero(Base::Vector);
        for (size_t c = 0; c < 3; c++) {
            const size_t i = (c + 1) % 3, j = (c + 2) % 3;
            r.n[c] = a.n[i] * b.n[j] - a.n[j] * b.n[i];
        }
        return r;
    }
    case ExprOp::Add:
    case ExprOp::Sub:
    case ExprOp::Mul:
    case ExprOp::Div:
        if (a.base != Base::Matrix) return component(op, a, b);
        if (op == ExprOp::Mul) return walkedProduct(a, b);
        if (op == ExprOp::Div) {
            const Shadeop* inverse = findShadeop("inverse");
            std::vector<Walked> arguments = {b};
            return walkedProduct(a, walkShadeop(*inverse, inverse->signatures[0], arguments));
        }
        unknown("this operator of matrices");
    default:
        break;
    }
    if (a.base == Base::String) return truth((a.s == b.s) == (op == ExprOp::Equal));
    bool all = true, any = false;
    for (size_t c = 0; c < size_t(width(a.base)); c++) {
        const bool one = compare(op, a.n[c], b.n[c]);
        all &= one;
        any |= one;
    }
    return truth(op == ExprOp::NotEqual ? any : all);
}

size_t nearest(float index, size_t length) {
    if (length == 0) unknown("elements of an empty array");
    if (!(index > 0)) return 0;
    return index >= float(length - 1) ? length - 1 : size_t(index);
}

} // namespace alpenglow::rsl::walking

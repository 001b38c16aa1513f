// Expressions: operators, conversions, spaces, arrays.
#include "rsl/ir/builder.h"
#include "rsl/passes/zerodivision.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

Inst* Builder::condition(const Expr& e) { return expr(e, Kind::Bool); }

/// && and ||. What the first operand decides alone leaves the second undone, as in C; one that only gives a value is computed all
/// the same where the points differ, which nobody sees.
Inst* Builder::both(const Expr& e) {
    const bool all = e.op == ExprOp::And;
    Inst* a = condition(*e.args[0]);
    if (isConst(a) && (a->numbers[0] != 0) != all) return boolean(!all);
    if (isConst(a)) return condition(*e.args[1]);
    if (hasEffects(*e.args[1])) {
        const auto second = [&] { return std::vector<Inst*>{condition(*e.args[1])}; };
        const auto decided = [&] { return std::vector<Inst*>{boolean(!all)}; };
        place_ = e.place;
        return all ? branch(a, second, decided)[0] : branch(a, decided, second)[0];
    }
    Inst* b = condition(*e.args[1]);
    place_ = e.place;
    return emit(all ? Op::And : Op::Or, Kind::Bool, {a, b});
}

Inst* Builder::binary(const Expr& e, Inst* a, Inst* b) {
    if (a->kind == Kind::Bool) a = coerce(a, Kind::Float);
    if (b->kind == Kind::Bool) b = coerce(b, Kind::Float);
    if (a->kind != b->kind) {
        const Kind k = a->kind == Kind::Float ? b->kind : a->kind;
        a = coerce(a, k);
        b = coerce(b, k);
    }
    const Kind k = a->kind;
    const auto compare = [&](Inst* x, Inst* y) {
        switch (e.op) {
        case ExprOp::Less:
            return emit(Op::Less, Kind::Bool, {x, y});
        case ExprOp::Greater:
            return emit(Op::Less, Kind::Bool, {y, x});
        case ExprOp::LessEqual:
            return emit(Op::LessEqual, Kind::Bool, {x, y});
        case ExprOp::GreaterEqual:
            return emit(Op::LessEqual, Kind::Bool, {y, x});
        case ExprOp::NotEqual:
            return emit(Op::NotEqual, Kind::Bool, {x, y});
        default:
            return emit(Op::Equal, Kind::Bool, {x, y});
        }
    };
    switch (e.op) {
    case ExprOp::Add:
        return emit(Op::Add, k, {a, b});
    case ExprOp::Sub:
        return emit(Op::Sub, k, {a, b});
    case ExprOp::Mul:
        return k == Kind::Matrix ? multiply(a, b) : emit(Op::Mul, k, {a, b});
    case ExprOp::Div:
        return k == Kind::Matrix ? multiply(a, runtime1("al_inverse", {b}, Kind::Matrix))
                                 : emit(Op::Div, k, {a, b}, ownText_ ? 0 : passes::kWrittenDivision);
    case ExprOp::Dot:
        return dot(coerce(a, Kind::Triple), coerce(b, Kind::Triple));
    case ExprOp::Cross:
        return cross(coerce(a, Kind::Triple), coerce(b, Kind::Triple));
    default:
        break;
    }
    if (k == Kind::Float || k == Kind::String) return compare(a, b);
    Inst* all = nullptr; // tuples and matrices: every component (any, for !=)
    for (int c = 0; c < components(k); ++c) {
        Inst* one = compare(emit(Op::Extract, Kind::Float, {a}, c), emit(Op::Extract, Kind::Float, {b}, c));
        all = all ? emit(e.op == ExprOp::NotEqual ? Op::Or : Op::And, Kind::Bool, {all, one}) : one;
    }
    return all;
}

Inst* Builder::array(const Expr& e) {
    if (e.kind == ExprKind::Variable && e.symbol) {
        const int n = slot(e.symbol);
        Inst*& v = value(n);
        if (!v) v = get(n);
        return v;
    }
    if (e.kind == ExprKind::Cast && !e.args.empty() && e.args[0]->type.array && !e.space) return array(*e.args[0]);
    if (e.kind == ExprKind::Cast && !e.args.empty() && e.args[0]->type.array)
        return inSpace(*e.space, array(*e.args[0]), e.type.base);
    if (e.kind == ExprKind::Member) return memberArray(e);
    if (returnsArray(e)) {
        std::vector<const Expr*> args;
        for (const ExprPtr& a : e.args) args.push_back(a.get());
        Inst* a = nullptr;
        inlineFunction(*e.function, args, &a);
        return a ? a : newArray(e.type.base, std::max(1, e.type.array));
    }
    if (e.type.array < 0 && e.kind == ExprKind::ShadeopCall && e.shadeop) { // the length is that of the result: getlights()
        Inst* a = newResizable(e.type.base, 0);
        copyResizable(a, e);
        return a;
    }
    const int length = e.type.array > 0 ? e.type.array : std::max<int>(1, static_cast<int>(e.args.size()));
    Inst* a = newArray(e.type.base, length);
    copyArray(a, e);
    return a;
}

void Builder::copyArray(Inst* to, const Expr& from) {
    const int n = arrayLength(to);
    const auto store = [&](int i, Inst* v) {
        emit(Op::ArrayStore, Kind::None, {to, constant(static_cast<float>(i)), coerce(v, to->element)});
    };
    if (from.kind == ExprKind::ArrayList) {
        std::vector<Inst*> values;
        for (const ExprPtr& a : from.args) values.push_back(expr(*a));
        for (int i = 0; i < n && i < static_cast<int>(values.size()); ++i) store(i, values[static_cast<size_t>(i)]);
        const int given = static_cast<int>(values.size());
        Inst* rest = from.text == "..." && given > 0 ? coerce(values.back(), to->element) : zero(to->element);
        if (given < n)
            everyElement(n - given, [&](Inst* at) {
                emit(Op::ArrayStore, Kind::None,
                     {to, emit(Op::Add, Kind::Float, {at, constant(static_cast<float>(given))}), rest});
            });
        return;
    }
    if (!from.type.array) { // float a[42] = 0: the value for every element
        Inst* v = coerce(expr(from), to->element);
        return everyElement(n, [&](Inst* at) { emit(Op::ArrayStore, Kind::None, {to, at, v}); });
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "getshaders") {
        for (int i = 0; i < n; ++i) store(i, zero(to->element));
        storeHandles(to, from);
        return;
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "bsdf") {
        const std::vector<Inst*> parts = bsdf(from);
        for (int i = 0; i < n; ++i)
            store(i, i < static_cast<int>(parts.size()) ? parts[static_cast<size_t>(i)] : zero(to->element));
        return;
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "trace") {
        const std::vector<Inst*> parts = traceParts(from);
        for (int i = 0; i < n; ++i)
            store(i, i < static_cast<int>(parts.size()) ? parts[static_cast<size_t>(i)] : zero(to->element));
        return;
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop && from.shadeop->name == "getlights") {
        const std::vector<Inst*> all = lightHandles(from);
        for (int i = 0; i < n; ++i)
            store(i, i + 1 < static_cast<int>(all.size()) ? all[static_cast<size_t>(i) + 1] : zero(to->element));
        return;
    }
    if (from.kind == ExprKind::ShadeopCall && from.shadeop) unavailable(from); // its results stay zero
    if (from.kind != ExprKind::Variable && from.kind != ExprKind::Cast && from.kind != ExprKind::Member && !returnsArray(from))
        return;
    Inst* a = array(from);
    if (a == to) return;
    const int m = std::min(n, arrayLength(a));
    everyElement(m, [&](Inst* at) {
        emit(Op::ArrayStore, Kind::None, {to, at, coerce(emit(Op::ArrayLoad, a->element, {a, at}), to->element)});
    });
}

void Builder::Held::hold(const Expr& place) {
    if (place.kind == ExprKind::Cast && !place.args.empty()) return hold(*place.args[0]);
    if (place.kind != ExprKind::Index || place.args.size() < 2) return;
    hold(*place.args[0]);
    const Expr& index = *place.args[1];
    if (index.kind == ExprKind::Number || builder_.held_.count(&index)) return;
    Inst* at = builder_.expr(index, Kind::Float);
    builder_.held_[&index] = at;
    indices_.push_back(&index);
}

void Builder::Held::again(const Expr& place, const Expr& copy) {
    if (place.kind != copy.kind || place.kind != ExprKind::Index || place.args.size() < 2) return;
    again(*place.args[0], *copy.args[0]);
    const auto at = builder_.held_.find(place.args[1].get());
    if (at == builder_.held_.end()) return;
    Inst* const value = at->second;
    builder_.held_[copy.args[1].get()] = value;
    indices_.push_back(copy.args[1].get());
}

/// Warns of a constant index that the array does not have.
void Builder::checkIndex(const Expr& index, const Inst* a, const Inst* at) {
    if (isConst(at) && lengthKnown(a) && (at->numbers[0] <= -1 || at->numbers[0] >= static_cast<float>(arrayLength(a))))
        report(index.place, msg::kIndexNearest(indexText(at->numbers[0]), arrayLength(a)));
}

void Builder::assign(const Expr& l, Inst* value) {
    const Held held(*this, l);
    if (l.kind == ExprKind::Cast && !l.args.empty()) return assign(*l.args[0], value);
    if (l.kind == ExprKind::Variable && l.symbol) {
        if (!l.symbol->type.array) set(slot(l.symbol), coerce(value, l.symbol->type));
        return;
    }
    if (l.kind != ExprKind::Index || l.args.size() < 2) return;
    const Expr& base = *l.args[0];
    if (base.type.array) {
        Inst* a = array(base);
        Inst* at = expr(*l.args[1], Kind::Float);
        checkIndex(*l.args[1], a, at);
        if (a->op == Op::ArrayNew) storeElement(a, elementOf(a, at), coerce(value, a->element));
        return;
    }
    Inst* old = expr(base, Kind::Triple);
    Inst* at = expr(*l.args[1], Kind::Float);
    assign(base, withComponent(old, at, coerce(value, Kind::Float)));
}

/// Reads a[i] of an array that has storage, an input or constant texts.
Inst* Builder::arrayElement(const Expr& e) {
    Inst* a = array(*e.args[0]);
    Inst* at = expr(*e.args[1], Kind::Float);
    checkIndex(*e.args[1], a, at);
    const auto open = given_.find(a); // as long as the scene wants it: behind that there is nothing
    const bool behind = open != given_.end() && isConst(at) && at->numbers[0] >= static_cast<float>(open->second);
    if (behind) return zero(a->element);
    if (const auto t = texts_.find(a);
        t != texts_.end() && isConst(at) && at->numbers[0] >= 0 && at->numbers[0] < static_cast<float>(t->second.size()))
        return leaves_.string(t->second[static_cast<size_t>(at->numbers[0])]);
    Inst* v = loadElement(a, elementOf(a, at));
    if (open == given_.end() || isConst(at)) return v;
    return emit(Op::Select, a->element,
                {emit(Op::LessEqual, Kind::Bool, {constant(static_cast<float>(open->second)), at}), zero(a->element), v});
}

Inst* Builder::assignment(const Expr& e) {
    const Expr& l = *e.args[0];
    if (l.type.array) {
        Inst* a = array(l);
        if (lengths(a)) copyResizable(a, *e.args[1]);
        else if (a->op == Op::ArrayNew) copyArray(a, *e.args[1]);
        return a;
    }
    Inst* v;
    uniformContext_ = l.symbol && l.symbol->storage == Storage::Uniform;
    std::optional<Held> held;
    if (e.text == "+=") { // of strings: the value is the call that joins them, with the place as it was
        held.emplace(*this, l);
        held->again(l, *e.args[1]->args[0]);
        v = expr(*e.args[1]);
    } else if (e.op == ExprOp::Assign || e.op == ExprOp::None) {
        v = expr(*e.args[1]);
    } else {
        held.emplace(*this, l);
        Inst* old = expr(l);
        Inst* r = expr(*e.args[1]);
        place_ = e.place;
        v = binary(e, old, r);
    }
    uniformContext_ = false;
    v = coerce(v, kindOf(l.type) == Kind::None ? v->kind : kindOf(l.type));
    assign(l, v);
    return v;
}

/// (a, b, c), or sixteen numbers of a matrix, in current space.
Inst* Builder::tuple(const Expr& e) {
    const bool matrix = e.kind == ExprKind::MatrixTuple;
    const Kind kind = matrix ? Kind::Matrix : Kind::Triple;
    std::vector<Inst*> c;
    for (const ExprPtr& a : e.args) c.push_back(expr(*a, Kind::Float));
    const bool complete = c.size() == (matrix ? 16 : 3);
    Inst* v = complete ? emit(matrix ? Op::MatrixOf : Op::Triple, kind, c) : coerce(c.empty() ? constant(0) : c[0], kind);
    return e.space && (complete || matrix) ? inSpace(*e.space, v, matrix ? Base::Matrix : e.type.base) : v;
}

Inst* Builder::binary(const Expr& e) {
    if (e.op == ExprOp::And || e.op == ExprOp::Or) return both(e);
    Inst* a = expr(*e.args[0]);
    Inst* b = expr(*e.args[1]);
    place_ = e.place;
    return binary(e, a, b);
}

Inst* Builder::conditional(const Expr& e) {
    Inst* c = condition(*e.args[0]);
    const auto side = [&](size_t n) { return [&e, n, this] { return std::vector<Inst*>{expr(*e.args[n], kindOf(e.type))}; }; };
    return branch(c, side(1), side(2))[0];
}

Inst* Builder::sequence(const Expr& e) {
    for (size_t n = 0; n + 1 < e.args.size(); ++n) expr(*e.args[n]);
    return expr(*e.args.back());
}

Inst* Builder::expr(const Expr& e) {
    if (failed_)
        return e.type.array ? newArray(e.type.base, 1) : zero(kindOf(e.type) == Kind::None ? Kind::Float : kindOf(e.type));
    if (!held_.empty())
        if (const auto known = held_.find(&e); known != held_.end()) return known->second;
    if (e.place.line) place_ = e.place;
    if (e.kind == ExprKind::Sequence) return sequence(e);
    if (e.type.array && e.kind != ExprKind::Assign && e.kind != ExprKind::FunctionCall && e.kind != ExprKind::ShadeopCall)
        return array(e);
    switch (e.kind) {
    case ExprKind::Number:
        return constant(static_cast<float>(e.number));
    case ExprKind::String:
        return e.handle && e.text.starts_with("(") ? handleText(e) : leaves_.string(e.text);
    case ExprKind::Variable:
        return e.symbol ? get(slot(e.symbol)) : zero(kindOf(e.type));
    case ExprKind::Index: {
        const Expr& base = *e.args[0];
        if (base.kind == ExprKind::Member) return memberElement(e);
        if (base.type.array) return arrayElement(e);
        Inst* v = expr(base, Kind::Triple);
        return component(v, expr(*e.args[1], Kind::Float));
    }
    case ExprKind::Unary:
        if (e.op == ExprOp::Not) return emit(Op::Not, Kind::Bool, {condition(*e.args[0])});
        return negative(expr(*e.args[0]));
    case ExprKind::Binary:
        return binary(e);
    case ExprKind::Assign:
        return assignment(e);
    case ExprKind::Conditional:
        return conditional(e);
    case ExprKind::Tuple:
    case ExprKind::MatrixTuple:
        return tuple(e);
    case ExprKind::ArrayList:
        return array(e);
    case ExprKind::Cast: {
        Inst* v = coerce(expr(*e.args[0]), e.type);
        return e.space ? inSpace(*e.space, v, e.type.base) : v;
    }
    case ExprKind::ShadeopCall:
        return shadeopCall(e);
    case ExprKind::FunctionCall:
        return e.shadeop ? shadeopCall(e) : functionCall(e);
    case ExprKind::Member:
        return memberAccess(e);
    case ExprKind::Method:
        return methodCall(e);
    case ExprKind::Sequence:
    case ExprKind::Part:
    case ExprKind::Construct:
        break;
    }
    return constant(0);
}

} // namespace alpenglow::rsl::ir

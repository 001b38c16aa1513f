// Expressions that are structures, in their parts; and expressions that have such parts in them.
#include "rsl/front/clone.h"
#include "rsl/front/lower.h"
#include "rsl/front/visit.h"
#include "rsl/front/writes.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

void inferFromOperands(Expr& e) {
    e.varying = false;
    for (const auto& a : e.args) {
        e.varying |= a->varying;
        e.height = std::max(e.height, a->height + 1);
    }
}

ExprPtr use(Symbol* s, Place place) {
    ExprPtr e = variable(s->name, place);
    e->symbol = s;
    e->type = s->type;
    e->varying = s->storage != Storage::Uniform;
    return e;
}

ExprPtr broken(Place place) { return variable("", place); }

ExprPtr assign(ExprPtr left, ExprPtr right, Place place) {
    auto e = node(ExprKind::Assign, place, ExprOp::Assign);
    e->type = left->type;
    const bool varying = right->varying;
    const bool plain = left->kind == ExprKind::Variable;
    adopt(*e, std::move(left));
    adopt(*e, std::move(right));
    inferFromOperands(*e);
    if (plain) e->varying = varying;
    return e;
}

ExprPtr floatOf(double v, Place place) {
    auto n = node(ExprKind::Number, place);
    n->number = v;
    n->type = kNumber;
    n->varying = false;
    return n;
}

ExprPtr choose(ExprPtr condition, ExprPtr yes, ExprPtr no, Place place) {
    auto c = node(ExprKind::Conditional, place);
    c->type = yes->type;
    adopt(*c, std::move(condition));
    adopt(*c, std::move(yes));
    adopt(*c, std::move(no));
    inferFromOperands(*c);
    return c;
}

/// An expression for a variable of any type, in its parts.
void Lowering::valueOf(ExprPtr e, Type want, List& pre, List& out) {
    if (isStruct(want)) return flatten(std::move(e), want, pre, out);
    rewrite(e);
    unroll(e, pre);
    out.push_back(std::move(e));
}

/// The parts of an element of an array of structures.
void Lowering::flattenElement(Expr& e, List& pre, List& out) {
    const Place place = e.place;
    const Type array = e.args[0]->type;
    List base;
    flatten(std::move(e.args[0]), array, pre, base);
    ExprPtr index = std::move(e.args[1]);
    rewrite(index);
    if (base.size() > 1 && index->kind != ExprKind::Number && index->kind != ExprKind::Variable) {
        Symbol* t = temporary(kNumber, place)[0]; // computed once
        pre.push_back(assign(use(t, place), std::move(index), place));
        index = use(t, place);
    }
    const std::vector<Leaf> inner = leaves(array.element());
    for (size_t n = 0; n < base.size(); ++n) {
        ExprPtr& b = base[n];
        const int each = n < inner.size() ? inner[n].type.array : 0;
        if (each || isSlice(*b)) {
            ExprPtr at = bounded(clone(*index), array.array, *b, std::max(1, each));
            out.push_back(partAt(std::move(b), std::move(at), each));
            continue;
        }
        auto i = node(ExprKind::Index, place);
        i->type = b->type.element();
        i->text = kElement;
        adopt(*i, std::move(b));
        adopt(*i, clone(*index));
        inferFromOperands(*i);
        out.push_back(std::move(i));
    }
}

/// condition ? a : b, both structures: the condition is computed once, and each part chooses by it.
void Lowering::flattenConditional(Expr& e, List& pre, List& out) {
    const Place place = e.place;
    const Type type = e.type;
    Symbol* t = temporary(kNumber, place)[0];
    rewrite(e.args[0]);
    pre.push_back(assign(use(t, place), choose(std::move(e.args[0]), floatOf(1, place), floatOf(0, place), place), place));
    const auto chosen = [&] { // t is not zero
        auto test = node(ExprKind::Binary, place, ExprOp::NotEqual);
        test->type = {Base::Bool, 0};
        adopt(*test, use(t, place));
        adopt(*test, floatOf(0, place));
        inferFromOperands(*test);
        return test;
    };
    List yes, no, yesFirst, noFirst;
    valueOf(std::move(e.args[1]), type, yesFirst, yes);
    valueOf(std::move(e.args[2]), type, noFirst, no);
    const std::vector<Leaf> all = leaves(type);
    if (!yesFirst.empty() || !noFirst.empty()) {
        // What a side does happens only where it is chosen: each stores its parts, and the number behind them is not used.
        const Symbols parts = temporary(type, place);
        const auto side = [&](List& first, List& values) {
            for (size_t i = 0; i < parts.size() && i < values.size(); ++i)
                first.push_back(assign(use(parts[i], place), whole(std::move(values[i])), place));
            ExprPtr done = floatOf(0, place);
            sequence(done, std::move(first));
            return done;
        };
        ExprPtr first = side(yesFirst, yes), second = side(noFirst, no);
        pre.push_back(assign(use(t, place), choose(chosen(), std::move(first), std::move(second), place), place));
        for (Symbol* p : parts) out.push_back(use(p, place));
        return;
    }
    const auto either = [&](ExprPtr a, ExprPtr b) { return choose(chosen(), std::move(a), std::move(b), place); };
    for (size_t i = 0; i < yes.size() && i < no.size(); ++i) {
        if (i >= all.size() || all[i].type.array <= 0) {
            out.push_back(either(std::move(yes[i]), std::move(no[i])));
            continue;
        }
        List first, second; // arrays one element after the other
        elements(std::move(yes[i]), all[i].type, pre, first);
        elements(std::move(no[i]), all[i].type, pre, second);
        ExprPtr list = node(ExprKind::ArrayList, place);
        list->type = all[i].type;
        for (size_t k = 0; k < first.size(); ++k) adopt(*list, either(std::move(first[k]), std::move(second[k])));
        inferFromOperands(*list);
        out.push_back(std::move(list));
    }
}

/// A call that gives a structure: its last arguments are variables that receive the members.
void Lowering::flattenCall(ExprPtr e, List& pre, List& out) {
    const Place place = e->place;
    const bool varying = e->varying;
    const Symbols t = temporary(e->type, place);
    List after;
    if (e->kind == ExprKind::Method) handleArguments(*e, pre);
    else arguments(*e, pre, after);
    for (Symbol* s : t) {
        adopt(*e, use(s, place));
        out.push_back(use(s, place));
        out.back()->varying = varying;
    }
    e->type = kNone;
    pre.push_back(std::move(e));
    for (auto& a : after) pre.push_back(std::move(a));
}

/// The type of a variable or a part of one that has none because something around it is wrong. False: it is neither.
bool Lowering::typed(Expr& e) {
    const bool part = e.kind == ExprKind::Part && (isStruct(e.args[0]->type) || typed(*e.args[0]));
    if (e.type.base != Base::Void) return isStruct(e.type) || part;
    switch (e.kind) {
    case ExprKind::Variable:
        if (!e.symbol || !isStruct(e.symbol->type)) return false;
        e.type = e.symbol->type;
        return true;
    case ExprKind::Index:
        if (!typed(*e.args[0]) || !isStruct(e.args[0]->type) || !e.args[0]->type.array) return false;
        e.type = e.args[0]->type.element();
        return true;
    case ExprKind::Part: {
        if (!part) return false;
        const StructMember* m = structures_.member(e.args[0]->type, e.text);
        if (!m) return false;
        e.type = {m->type.base, Structures::flatLength(e.args[0]->type.array, m->type.array), m->type.structure};
        return true;
    }
    default:
        return false;
    }
}

/// An assignment to a structure whose right side is wrong: it is one all the same.
void Lowering::typedAssign(Expr& e) {
    const bool untyped = e.kind == ExprKind::Assign && e.op == ExprOp::Assign && e.type.base == Base::Void;
    if (untyped && typed(*e.args[0]) && isStruct(e.args[0]->type)) e.type = e.args[0]->type;
}

/// The plain members of an expression that is a structure. Effects that must come first are appended to `pre`.
void Lowering::flatten(ExprPtr e, Type want, List& pre, List& out) {
    const Place place = e->place;
    const auto wrong = [&] {
        for (size_t i = 0, n = leaves(want).size(); i < n; ++i) out.push_back(broken(place));
    };
    if (!isStruct(e->type)) return wrong();
    switch (e->kind) {
    case ExprKind::Variable: {
        const auto parts = parts_.find(e->symbol);
        if (parts == parts_.end()) return wrong();
        for (Symbol* s : parts->second) out.push_back(use(s, place));
        return;
    }
    case ExprKind::Index:
        return flattenElement(*e, pre, out);
    case ExprKind::Part:
        return pick(*e, pre, out);
    case ExprKind::Cast: { // the part that is extended
        const size_t end = out.size() + leaves(e->type).size();
        const Type inner = e->args[0]->type;
        flatten(std::move(e->args[0]), isStruct(inner) ? inner : want, pre, out);
        if (out.size() > end) out.resize(end);
        return;
    }
    case ExprKind::Construct: {
        const auto& members = structures_.of(e->type).members;
        if (e->args.size() != members.size()) return wrong();
        for (size_t i = 0; i < members.size(); ++i) valueOf(std::move(e->args[i]), members[i].type, pre, out);
        return;
    }
    case ExprKind::Conditional:
        return flattenConditional(*e, pre, out);
    case ExprKind::Assign:
        return assignTo(*e, pre, &out);
    case ExprKind::ArrayList:
        return listOf(*e, pre, out);
    case ExprKind::ShadeopCall:
        if (e->text == "pop" && e->shadeop) return popLast(*e, pre, out);
        return wrong();
    case ExprKind::FunctionCall:
    case ExprKind::Method:
        return flattenCall(std::move(e), pre, out);
    default:
        return wrong();
    }
}

/// The parts of a member.
void Lowering::pick(Expr& e, List& pre, List& out) {
    const Type type = e.args[0]->type;
    List base;
    flatten(std::move(e.args[0]), type, pre, base);
    size_t at = 0;
    for (const StructMember& m : structures_.of(type).members) {
        const size_t parts = isStruct(m.type) ? leaves(m.type).size() : 1;
        if (m.name == e.text)
            for (size_t i = 0; i < parts; ++i) out.push_back(at + i < base.size() ? std::move(base[at + i]) : broken(e.place));
        at += parts;
    }
    if (out.empty()) out.push_back(broken(e.place));
}

/// left = right, both structures. `value` receives the members of the result, if it is used.
void Lowering::assignTo(Expr& e, List& pre, List* value) {
    const Type type = e.type;
    const Place place = e.place;
    const bool simple = path(*e.args[1]) || type.array;
    List left, right;
    flatten(std::move(e.args[0]), type, pre, left);
    valueOf(std::move(e.args[1]), type, pre, right);
    if (!simple && right.size() > 1) spill(right, type, pre, place); // a = S(a->y, a->x)
    for (size_t i = 0; value && i < left.size(); ++i)
        value->push_back(clone(*left[i])); // indices are numbers and variables by now
    const std::vector<Leaf> all = leaves(type);
    for (size_t i = 0; i < left.size() && i < right.size() && i < all.size(); ++i)
        store(std::move(left[i]), std::move(right[i]), all[i].type.base, place, pre);
}

bool Lowering::path(const Expr& e) {
    if (e.kind == ExprKind::Variable) return true;
    return (e.kind == ExprKind::Index || e.kind == ExprKind::Part || e.kind == ExprKind::Cast) && path(*e.args[0]);
}

/// Is it an element of an array, or inside of one?
bool Lowering::inArray(const Expr& e) {
    return e.kind == ExprKind::Index || ((e.kind == ExprKind::Part || e.kind == ExprKind::Cast) && inArray(*e.args[0]));
}

/// May the call change that argument?
bool Lowering::putsOut(const Expr& call, size_t i) const {
    if (call.signature) return writesArgument(call, i) != Writes::No;
    const auto f = outputs_.find(call.function);
    return f != outputs_.end() && i < f->second.size() && f->second[i];
}

void Lowering::arguments(Expr& call, List& pre, List& after) {
    List given = std::move(call.args);
    std::vector<bool> outputs;
    call.args.swap(given);
    for (size_t i = 0; i < call.args.size(); ++i) outputs.push_back(putsOut(call, i));
    call.args.swap(given);
    for (size_t i = 0; i < given.size(); ++i) {
        ExprPtr& a = given[i];
        const Type type = a->type;
        if (a->kind == ExprKind::Part && type.array && !isStruct(type) && inArray(*a->args[0])) { // of one of many structures
            List out;
            pick(*a, pre, out);
            adopt(call, argument(std::move(out[0]), type, outputs[i], pre, after));
            continue;
        }
        if (!isStruct(type)) {
            rewrite(a);
            unroll(a, pre);
            hoist(a, pre);
            adopt(call, std::move(a));
            continue;
        }
        const bool value = outputs[i] && !path(*a); // what a method is called for, and changes
        List parts;
        flatten(std::move(a), type, pre, parts);
        const std::vector<Leaf> all = leaves(type);
        if (value) spill(parts, type, pre, call.place);
        for (size_t n = 0; n < parts.size(); ++n)
            adopt(call, argument(std::move(parts[n]), n < all.size() ? all[n].type : kNone, outputs[i], pre, after));
    }
}

/// The arguments of a method of another shader: a structure is passed as its members, as the method declares it.
void Lowering::handleArguments(Expr& call, List& pre) {
    List given = std::move(call.args);
    call.args.clear();
    for (ExprPtr& a : given) {
        List parts;
        const Type type = a->type;
        valueOf(std::move(a), type, pre, parts);
        for (auto& p : parts) adopt(call, whole(std::move(p)));
    }
}

/// The arguments of a call that means nothing: what is read in them is read.
void Lowering::brokenArguments(Expr& call) {
    List given = std::move(call.args);
    call.args.clear();
    for (ExprPtr& a : given) {
        List pre, parts;
        if (typed(*a) && isStruct(a->type)) {
            const Type type = a->type;
            flatten(std::move(a), type, pre, parts);
            for (auto& p : parts) adopt(call, whole(std::move(p)));
        } else {
            rewrite(a);
            adopt(call, std::move(a));
        }
    }
}

/// What must happen first, and then the expression, as one expression.
void Lowering::sequence(ExprPtr& e, List pre) {
    if (pre.empty()) return;
    auto all = node(ExprKind::Sequence, e->place);
    all->type = e->type;
    for (auto& p : pre) adopt(*all, std::move(p));
    adopt(*all, std::move(e));
    inferFromOperands(*all);
    e = std::move(all);
}

/// What must happen before a place can be named (the index of an element), and then the place alone: it may be written.
void Lowering::hoist(ExprPtr& place, List& pre) {
    if (place->kind == ExprKind::Index) return hoist(place->args[0], pre);
    if (place->kind != ExprKind::Sequence || place->args.back()->kind != ExprKind::Index) return;
    ExprPtr last = std::move(place->args.back());
    place->args.pop_back();
    for (auto& first : place->args) pre.push_back(std::move(first));
    place = std::move(last);
}

void Lowering::unroll(ExprPtr& array, List& pre) {
    if (!array || !array->type.array || array->kind != ExprKind::Sequence) return;
    ExprPtr last = std::move(array->args.back());
    array->args.pop_back();
    for (auto& first : array->args) pre.push_back(std::move(first));
    array = std::move(last);
}

/// A member, or what stands in the place of a structure that is wrong there.
void Lowering::rewriteParts(ExprPtr& e) {
    const Place place = e->place;
    List pre, out;
    if (isStruct(e->type) || e->kind != ExprKind::Part || !typed(*e) || isStruct(e->type)) {
        if (isStruct(e->type) &&
            (e->kind == ExprKind::Assign || e->kind == ExprKind::FunctionCall || e->kind == ExprKind::Method)) {
            const Type type = e->type; // for its effect, where there is no statement
            flatten(std::move(e), type, pre, out);
            e = floatOf(0, place);
            return sequence(e, std::move(pre));
        }
        e = broken(place);
        return;
    }
    pick(*e, pre, out);
    e = std::move(out[0]);
    if (isSlice(*e)) { // the values; what happens first, before the first of them
        e = whole(std::move(e));
        sequence(e->args[0], std::move(pre));
        e->height = std::max(e->height, e->args[0]->height + 1);
        return;
    }
    sequence(e, std::move(pre));
}

/// An expression that is no structure itself.
void Lowering::rewrite(ExprPtr& e) {
    if (!e) return;
    typedAssign(*e);
    const bool variable = e->kind == ExprKind::Variable && e->symbol && isStruct(e->symbol->type);
    if (isStruct(e->type) || variable || e->kind == ExprKind::Construct) return rewriteParts(e);
    if (rewriteArray(e)) return;
    if (e->kind == ExprKind::Part) return rewriteParts(e);
    List pre, after;
    const bool call = e->kind == ExprKind::ShadeopCall || e->kind == ExprKind::FunctionCall;
    if (call && e->args.size() == 1 && isStruct(e->args[0]->type) && (e->text == "arraylength" || e->text == "capacity")) {
        measure(e, pre);
        return sequence(e, std::move(pre));
    }
    if (e->kind == ExprKind::ShadeopCall && changeLength(*e, pre)) {
        e = floatOf(0, e->place);
        return sequence(e, std::move(pre));
    }
    const bool resolved = e->shadeop || e->function;
    const bool joins = e->kind == ExprKind::Assign && e->text == "+="; // a = concat(a, b), which names its place once
    if (joins) {
        rewrite(e->args[0]);
        hoist(e->args[0], pre);
        rewrite(e->args[1]->args[1]);
        e->args[1]->args[0] = clone(*e->args[0]);
    } else if (call && resolved) arguments(*e, pre, after);
    else if (call) brokenArguments(*e);
    else if (e->kind == ExprKind::Method && e->type.base == Base::Void && !e->args.empty() && typed(*e->args[0]))
        brokenArguments(*e);
    else if (e->kind == ExprKind::Method) handleArguments(*e, pre);
    else {
        for (auto& a : e->args) {
            rewrite(a);
            unroll(a, pre);
        }
        if (e->kind == ExprKind::Assign) hoist(e->args[0], pre);
    }
    rewrite(e->space);
    rewrite(e->channel);
    for (auto& p : e->pairs) {
        rewrite(p.value);
        unroll(p.value, pre);
    }
    for (const auto& a : e->args)
        if (a) e->height = std::max(e->height, a->height + 1);
    if (!after.empty()) called(e, pre, std::move(after));
    sequence(e, std::move(pre));
}

/// A call and what must happen behind it, which has the value of the call.
void Lowering::called(ExprPtr& e, List& pre, List after) {
    const Place place = e->place;
    const Type result = e->type;
    if (result == kNone) {
        pre.push_back(std::move(e));
        e = std::move(after.back());
        after.pop_back();
        for (auto& a : after) pre.push_back(std::move(a));
        return;
    }
    Symbol* t = temporary(result, place)[0];
    pre.push_back(assign(use(t, place), std::move(e), place));
    for (auto& a : after) pre.push_back(std::move(a));
    e = use(t, place);
}

} // namespace alpenglow::rsl::front

// Expressions that are structures, in their parts; and expressions that have such parts in them.
#include "rsl/front/clone.h"
#include "rsl/front/structs_lowering.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::front {

/// An expression for a variable of any type, in its parts.
void Lowering::valueOf(ExprPtr e, Type want, List& pre, List& out) {
    if (!isStruct(want)) {
        rewrite(e);
        out.push_back(std::move(e));
        return;
    }
    const size_t count = leaves(want).size();
    const Place place = e->place;
    if (want.array && e->kind == ExprKind::ArrayList) return listOf(*e, want, pre, out);
    if (!want.array && e->kind == ExprKind::ArrayList) { // {a, b}: like the constructor
        construct(want, *e, pre, out);
        return;
    }
    Type have = typeOf(*e);
    if (isStruct(have) && e->kind == ExprKind::ShadeopCall && structNamed(e->text) < 0 && !derives(have, want.base))
        if (const Type other = resultOf(e->text, e->args, want.base); isStruct(other)) have = other;
    const bool fits = derives(have, want.base) && // of one that extends it the part that it extends
                      (have.array != 0) == (want.array != 0) && (have.array == want.array || have.array < 0 || want.array < 0);
    if (!fits) {
        if (isStruct(have)) sources_.report(place, msg::kStructOther(shown(want), shown(have)));
        else {
            const int errors = sources_.errors();
            rewrite(e);
            if (sources_.errors() == errors) sources_.report(place, msg::kStructValue(shown(want)));
        }
        for (size_t i = 0; i < count; ++i) out.push_back(variable("", place));
        return;
    }
    const size_t before = out.size();
    flatten(std::move(e), pre, out, have);
    if (out.size() > before + count) out.resize(before + count);
}

/// Name(a, b, ...) or {a, b, ...}.
void Lowering::construct(Type type, Expr& e, List& pre, List& out) {
    const StructType& s = structOf(type);
    if (e.args.size() > s.members.size())
        sources_.report(e.place, msg::kStructMemberCount(shown(type), s.members.size(), e.args.size()));
    List rest;
    defaults(type, e.place, pre, rest);
    size_t at = 0;
    for (size_t m = 0; m < s.members.size(); ++m) {
        const size_t parts = isStruct(s.members[m].type) ? leaves(s.members[m].type).size() : 1;
        if (m < e.args.size()) {
            valueOf(std::move(e.args[m]), s.members[m].type, pre, out);
        } else {
            for (size_t i = 0; i < parts && at + i < rest.size(); ++i) out.push_back(std::move(rest[at + i]));
        }
        at += parts;
    }
}

/// The parts of an element of an array of structures.
void Lowering::flattenElement(Expr& e, Type type, List& pre, List& out) {
    const Place place = e.place;
    List base;
    const int length = typeOf(*e.args[0]).array;
    const auto inner = leaves(type);
    flatten(std::move(e.args[0]), pre, base);
    ExprPtr index = std::move(e.args[1]);
    rewrite(index);
    if (base.size() > 1 && index->kind != ExprKind::Number && index->kind != ExprKind::Variable) {
        const std::string t = temporary({Base::Float, 0}, place); // computed once
        pre.push_back(assign(variable(t, place), std::move(index), place));
        index = variable(t, place);
    }
    for (size_t n = 0; n < base.size(); ++n) {
        ExprPtr& b = base[n];
        const int each = n < inner.size() ? inner[n].type.array : 0;
        if (each || isSlice(*b)) {
            ExprPtr at = bounded(clone(*index), length, *b, std::max(1, each));
            out.push_back(partAt(std::move(b), std::move(at), each));
            continue;
        }
        auto i = node(ExprKind::Index, place);
        adopt(*i, std::move(b));
        adopt(*i, clone(*index));
        out.push_back(std::move(i));
    }
}

static ExprPtr numberNode(double v, Place place) {
    auto n = node(ExprKind::Number, place);
    n->number = v;
    return n;
}

static ExprPtr choose(ExprPtr condition, ExprPtr yes, ExprPtr no, Place place) {
    auto c = node(ExprKind::Conditional, place);
    adopt(*c, std::move(condition));
    adopt(*c, std::move(yes));
    adopt(*c, std::move(no));
    return c;
}

/// condition ? a : b, both structures: the condition is computed once, and each part chooses by it.
void Lowering::flattenConditional(Expr& e, Type type, List& pre, List& out) {
    const Place place = e.place;
    const std::string t = temporary({Base::Float, 0}, place);
    rewrite(e.args[0]);
    pre.push_back(
        assign(variable(t, place), choose(std::move(e.args[0]), numberNode(1, place), numberNode(0, place), place), place));
    List yes, no, yesFirst, noFirst;
    valueOf(std::move(e.args[1]), type, yesFirst, yes);
    valueOf(std::move(e.args[2]), type, noFirst, no);
    const auto all = leaves(type);
    if (!yesFirst.empty() || !noFirst.empty()) {
        // What a side does happens only where it is chosen: each stores its parts, and the number behind them is not used.
        const std::string chosen = temporary(type, place);
        const auto side = [&](List& first, List& parts) {
            for (size_t i = 0; i < all.size() && i < parts.size(); ++i)
                first.push_back(assign(variable(chosen + all[i].path, place), whole(std::move(parts[i])), place));
            ExprPtr done = node(ExprKind::Number, place);
            sequence(done, std::move(first));
            return done;
        };
        ExprPtr first = side(yesFirst, yes), second = side(noFirst, no);
        pre.push_back(assign(variable(t, place), choose(variable(t, place), std::move(first), std::move(second), place), place));
        for (const Leaf& l : all) out.push_back(variable(chosen + l.path, place));
        return;
    }
    const auto either = [&](ExprPtr a, ExprPtr b) { return choose(variable(t, place), std::move(a), std::move(b), place); };
    for (size_t i = 0; i < yes.size() && i < no.size(); ++i) {
        if (i >= all.size() || all[i].type.array <= 0) {
            out.push_back(either(std::move(yes[i]), std::move(no[i])));
            continue;
        }
        List first, second; // arrays one element after the other
        elements(std::move(yes[i]), all[i].type, pre, first);
        elements(std::move(no[i]), all[i].type, pre, second);
        out.push_back(node(ExprKind::ArrayList, place));
        for (size_t k = 0; k < first.size(); ++k) adopt(*out.back(), either(std::move(first[k]), std::move(second[k])));
    }
}

/// A call that returns a structure: its last arguments are variables that receive the members.
void Lowering::flattenCall(ExprPtr e, Type type, List& pre, List& out) {
    if (structNamed(e->text) >= 0) return construct(type, *e, pre, out);
    if (e->text == "pop") return popLast(*e, type, pre, out);
    const Place place = e->place;
    const std::string t = temporary(type, place);
    List after;
    arguments(*e, pre, after);
    const size_t first = e->args.size();
    for (const Leaf& l : leaves(type)) {
        adopt(*e, variable(t + l.path, place));
        out.push_back(variable(t + l.path, place));
    }
    if (first < e->args.size()) e->args[first]->whole = wholeOf(type, e->args.size() - first, true);
    pre.push_back(std::move(e));
    for (auto& a : after) pre.push_back(std::move(a));
}

/// The plain members of an expression that is a structure. Effects that must come first are appended to `pre`.
/// `as`: its type, where that is known already.
void Lowering::flatten(ExprPtr e, List& pre, List& out, Type as) {
    const Type type = isStruct(as) ? as : typeOf(*e);
    const Place place = e->place;
    if (!isStruct(type)) {
        if (sources_.errors() == 0) sources_.report(place, msg::kStructAny);
        return;
    }
    methodCall(*e);
    switch (e->kind) {
    case ExprKind::Variable:
        for (const Leaf& l : leaves(type)) {
            out.push_back(variable(e->text + l.path, place));
            out.back()->part = true;
        }
        return;
    case ExprKind::Index:
        return flattenElement(*e, type, pre, out);
    case ExprKind::Member:
        return pick(*e, pre, out);
    case ExprKind::Cast:
        return flatten(std::move(e->args[0]), pre, out);
    case ExprKind::Conditional:
        return flattenConditional(*e, type, pre, out);
    case ExprKind::Assign:
        return assignTo(*e, pre, &out);
    case ExprKind::ShadeopCall:
        return flattenCall(std::move(e), type, pre, out);
    default:
        for (size_t i = 0; i < leaves(type).size(); ++i) out.push_back(variable("", place));
    }
}

/// The parts of a member.
void Lowering::pick(Expr& e, List& pre, List& out) {
    const Type type = typeOf(*e.args[0]);
    List base;
    flatten(std::move(e.args[0]), pre, base);
    size_t at = 0;
    for (const StructMember& m : structOf(type).members) {
        const size_t parts = isStruct(m.type) ? leaves(m.type).size() : 1;
        if (m.name == e.text)
            for (size_t i = 0; i < parts; ++i) {
                out.push_back(at + i < base.size() ? std::move(base[at + i]) : variable("", e.place));
                if (isStruct(m.type)) continue;
                Expr* root = out.back().get(); // a plain member is named itself
                while (root->kind == ExprKind::Index) root = root->args[0].get();
                root->part = false;
            }
        at += parts;
    }
}

/// left = right, both structures. `value` receives the members of the result, if it is used.
void Lowering::assignTo(Expr& e, List& pre, List* value) {
    const Type type = typeOf(*e.args[0]);
    const Place place = e.place;
    if (e.op != ExprOp::Assign) {
        sources_.report(place, msg::kStructAssigned);
        return;
    }
    const bool simple = path(*e.args[1]) || type.array || e.args[1]->kind == ExprKind::ArrayList;
    const bool list = e.args[1]->kind == ExprKind::ArrayList;
    List left, right;
    flatten(std::move(e.args[0]), pre, left);
    valueOf(std::move(e.args[1]), type, pre, right);
    if ((!simple || (list && !type.array)) && right.size() > 1) spill(right, type, pre, place); // a = S(a->y, a->x)
    for (size_t i = 0; value && i < left.size(); ++i)
        value->push_back(clone(*left[i])); // indices are numbers and variables by now
    const auto all = leaves(type);
    for (size_t i = 0; i < left.size() && i < right.size() && i < all.size(); ++i)
        store(std::move(left[i]), std::move(right[i]), all[i].type.base, place, pre);
}

bool Lowering::path(const Expr& e) {
    if (e.kind == ExprKind::Variable) return true;
    return (e.kind == ExprKind::Index || e.kind == ExprKind::Member) && path(*e.args[0]);
}

/// Structures of the same members are not the same: behind this pass nobody could tell. Reported once for the first that does not
/// fit.
void Lowering::checkArguments(Expr& call) {
    const auto [from, to] = functions_.equal_range(call.text);
    if (from == to) return;
    std::vector<Type> types;
    for (const auto& a : call.args) types.push_back(typeOf(*a));
    const Expr* wrong = nullptr;
    Type wanted, have;
    for (auto f = from; f != to; ++f) {
        const auto& parameters = f->second.parameters;
        if (parameters.size() != call.args.size()) continue;
        if (accepts(f->second, call.args, types)) return;
        for (size_t i = 0; !wrong && i < parameters.size(); ++i) {
            if (isStruct(types[i]) ? derives(types[i], parameters[i].base) : !isStruct(parameters[i]) || isList(*call.args[i]))
                continue;
            wrong = call.args[i].get();
            wanted = parameters[i];
            have = types[i];
        }
    }
    if (!wrong) return;
    if (isStruct(wanted) && isStruct(have)) sources_.report(wrong->place, msg::kStructOther(shown(wanted), shown(have)));
    else if (isStruct(wanted)) sources_.report(wrong->place, msg::kStructValue(shown(wanted)));
    else sources_.report(wrong->place, msg::kStructUse(shown(have)));
    call.text.clear(); // no more messages about this call
}

/// Whether the function that a call means is a method of a structure, whose first argument is the structure.
bool Lowering::isMethod(const std::string& function) { return function.find("->") != function.npos; }

/// Whether a call means a shadeop that shows or stores values of any type, such as printf(): each part of a structure would be
/// one.
bool Lowering::takesAnything(const std::string& function) const {
    const Shadeop* op = functions_.count(function) ? nullptr : findShadeop(function);
    const auto any = [](const Signature& s) {
        return std::ranges::any_of(s.parameters, [](const auto& p) { return p.type.base == Base::Void; });
    };
    return op && std::ranges::any_of(op->signatures, any);
}

/// Whether every function that a call can mean stores a value in this argument, which is none that can be stored in.
bool Lowering::mustBeVariable(const std::string& function, size_t arguments, size_t i, const Expr& argument) const {
    bool outputs = true, any = false;
    const auto [from, to] = functions_.equal_range(function);
    for (auto f = from; f != to; ++f) {
        if (f->second.parameters.size() != arguments) continue;
        any = true;
        outputs &= f->second.outputs[i];
    }
    return any && outputs && !path(argument);
}

Whole Lowering::wholeOf(Type t, size_t members, bool self) { return {int(t.base) - kFirstStruct, int(members), t.array, self}; }

void Lowering::arguments(Expr& call, List& pre, List& after) {
    checkArguments(call);
    std::vector<ExprPtr> given = std::move(call.args);
    call.args.clear();
    for (size_t i = 0; i < given.size(); ++i) {
        ExprPtr& a = given[i];
        if (const StructMember* m = arrayMember(*a); m && inArray(*a->args[0])) { // the array of one of many structures
            List out;
            pick(*a, pre, out);
            adopt(call, argument(std::move(out[0]), m->type, putsOut(call.text, given.size(), i), pre, after));
            continue;
        }
        if (!isStruct(typeOf(*a))) {
            rewrite(a);
            hoist(a, pre);
            adopt(call, std::move(a));
            continue;
        }
        const Type type = typeOf(*a);
        const bool anything = takesAnything(call.text), receiver = i == 0 && isMethod(call.text);
        if (anything || (!receiver && mustBeVariable(call.text, given.size(), i, *a))) {
            if (anything) sources_.report(a->place, msg::kStructUse(shown(type)), "a member is read by '->'");
            else sources_.report(a->place, msg::kOutputArgument(call.text));
            adopt(call, variable("", a->place)); // no more messages about it
            continue;
        }
        const Base want = wanted(call.text, given.size(), i, type);
        List parts;
        flatten(std::move(a), pre, parts);
        const auto all = leaves({want, 0});
        if (isStruct({want, 0}) && parts.size() > all.size()) parts.resize(all.size());
        const bool output = putsOut(call.text, given.size(), i);
        const size_t first = call.args.size();
        for (size_t n = 0; n < parts.size(); ++n)
            adopt(call, argument(std::move(parts[n]), n < all.size() ? all[n].type : kNone, output, pre, after));
        if (first < call.args.size()) call.args[first]->whole = wholeOf(type, call.args.size() - first, receiver);
    }
}

/// The arguments of a method of another shader: a structure is passed as its members, as the method declares it.
void Lowering::handleArguments(Expr& call, List& pre) {
    std::vector<ExprPtr> given = std::move(call.args);
    call.args.clear();
    for (ExprPtr& a : given) {
        List parts;
        if (!call.args.empty() && isStruct(typeOf(*a))) flatten(std::move(a), pre, parts);
        else if (isStruct(typeOf(*a))) parts.push_back(std::move(a)); // reported already
        else {
            rewrite(a);
            parts.push_back(std::move(a));
        }
        for (auto& p : parts) adopt(call, whole(std::move(p)));
    }
}

/// The structure as which argument `i` of type `have` is passed: its own, or the nearest of those that it extends.
Base Lowering::wanted(const std::string& function, size_t arguments, size_t i, Type have) const {
    Base found = have.base;
    int nearest = -1;
    const auto [from, to] = functions_.equal_range(function);
    for (auto f = from; f != to; ++f) {
        const auto& parameters = f->second.parameters;
        if (parameters.size() != arguments) continue;
        const int steps = extensions(have, parameters[i].base);
        if (steps < 0 || (nearest >= 0 && steps >= nearest)) continue;
        found = parameters[i].base;
        nearest = steps;
    }
    return found;
}

/// What must happen first, and then the expression, as one expression.
void Lowering::sequence(ExprPtr& e, List pre) {
    if (pre.empty()) return;
    auto all = node(ExprKind::Sequence, e->place);
    for (auto& p : pre) adopt(*all, std::move(p));
    adopt(*all, std::move(e));
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

/// An expression that is no structure itself.
void Lowering::rewrite(ExprPtr& e) {
    if (!e) return;
    if (const Type t = typeOf(*e); isStruct(t)) {
        sources_.report(e->place, msg::kStructUse(shown(t)), "a member is read by '->'");
        e = variable("", e->place);
        return;
    }
    if (rewriteArray(e)) return;
    List pre, after;
    methodCall(*e);
    regions(*e);
    if (e->kind == ExprKind::Binary && e->op == ExprOp::Dot && isStruct(typeOf(*e->args[0]))) {
        sources_.report(e->place, msg::kMemberDot);
        e = variable("", e->place);
        return;
    }
    if (e->kind == ExprKind::Member) {
        const Type t = typeOf(*e->args[0]);
        if (isStruct(t)) {
            const StructMember* m = t.array ? nullptr : member(t, e->text);
            if (!m) {
                std::vector<std::string> names;
                for (const StructMember& x : structOf(t).members) names.push_back(x.name);
                const std::string near = nearestName(e->text, names);
                if (t.array)
                    sources_.report(e->place, msg::kStructIsArray(shown(t.element())),
                                    "its elements have members: a[i]->" + e->text);
                else
                    sources_.report(e->place, msg::kNoSuchMember(shown(t), e->text),
                                    near.empty() ? "" : "did you mean '" + near + "'?");
                e = variable("", e->place);
                return;
            }
            const bool array = m->type.array != 0;
            List out;
            const Place place = e->place;
            pick(*e, pre, out);
            e = std::move(out[0]);
            if (isSlice(*e)) { // the values; what happens first, before the first of them
                e = whole(std::move(e));
                sequence(e->args[0], std::move(pre));
                e->height = std::max(e->height, e->args[0]->height + 1);
                return;
            }
            if (array && !pre.empty()) sources_.report(place, msg::kStructResultArray);
            sequence(e, std::move(pre));
            return;
        }
    }
    if (e->kind == ExprKind::ShadeopCall) {
        const bool sizes = e->text == "arraylength" || e->text == "capacity";
        if (sizes && e->args.size() == 1 && isStruct(typeOf(*e->args[0]))) {
            measure(e, pre);
            sequence(e, std::move(pre));
            return;
        }
        arguments(*e, pre, after);
    } else if (e->kind == ExprKind::Method) {
        handleArguments(*e, pre);
    } else {
        for (auto& a : e->args) rewrite(a);
        if (e->kind == ExprKind::Assign) hoist(e->args[0], pre);
    }
    rewrite(e->space);
    rewrite(e->channel);
    for (auto& p : e->pairs) rewrite(p.value);
    for (const auto& a : e->args)
        if (a) e->height = std::max(e->height, a->height + 1);
    if (!after.empty()) called(e, pre, std::move(after));
    sequence(e, std::move(pre));
}

/// A call and what must happen behind it, which has the value of the call.
void Lowering::called(ExprPtr& e, List& pre, List after) {
    const Place place = e->place;
    Type result = kNone;
    const auto [from, to] = functions_.equal_range(e->text);
    for (auto f = from; f != to; ++f) result = f->second.type;
    if (result.array) sources_.report(place, msg::kStructResultArray);
    if (result == kNone) {
        pre.push_back(std::move(e));
        e = std::move(after.back());
        after.pop_back();
        for (auto& a : after) pre.push_back(std::move(a));
        return;
    }
    const std::string t = temporary({result.base, 0}, place);
    pre.push_back(assign(variable(t, place), std::move(e), place));
    for (auto& a : after) pre.push_back(std::move(a));
    e = variable(t, place);
}

} // namespace alpenglow::rsl::front

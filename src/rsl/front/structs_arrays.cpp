// Arrays of structures that hold arrays: a member of n elements in an array of m structures is one array of m * n. What one
// structure has of it is a slice, an Index node with `text` "slice", args the variable and where it begins, `number` its length;
// no slice is left when the pass is done.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/structs_lowering.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

constexpr const char* kSlice = "slice";

ExprPtr number(double value, Place place) {
    auto e = node(ExprKind::Number, place);
    e->number = value;
    return e;
}

/// a + b, a * b; of two numbers the number.
ExprPtr joined(ExprOp op, ExprPtr a, ExprPtr b) {
    if (a->kind == ExprKind::Number && b->kind == ExprKind::Number)
        return number(op == ExprOp::Add   ? a->number + b->number
                      : op == ExprOp::Mul ? a->number * b->number
                                          : a->number / b->number,
                      a->place);
    if (op == ExprOp::Add && a->kind == ExprKind::Number && a->number == 0) return b;
    if (op == ExprOp::Add && b->kind == ExprKind::Number && b->number == 0) return a;
    auto e = node(ExprKind::Binary, a->place, op);
    adopt(*e, std::move(a));
    adopt(*e, std::move(b));
    return e;
}

/// A function of the renderer, whatever functions the shader has.
ExprPtr shipped(const char* name, ExprPtr a, Place place) {
    auto e = node(ExprKind::ShadeopCall, place);
    e->text = std::string("::") + name;
    adopt(*e, std::move(a));
    return e;
}

/// The number of whole structures in so many elements, `each` per structure. Values of a scene may end within one.
ExprPtr wholeStructures(ExprPtr elements, int each) {
    const Place place = elements->place;
    return each == 1 ? std::move(elements)
                     : shipped("floor", joined(ExprOp::Div, std::move(elements), number(each, place)), place);
}

ExprPtr indexed(ExprPtr array, ExprPtr at) {
    auto e = node(ExprKind::Index, at->place);
    e->place = array->place;
    adopt(*e, std::move(array));
    adopt(*e, std::move(at));
    return e;
}

} // namespace

bool Lowering::isSlice(const Expr& e) { return e.kind == ExprKind::Index && e.text == kSlice; }

/// m structures of so many elements each; -1: as many as there are.
int Lowering::flatLength(int outer, int inner) {
    if (outer == 0) return inner;
    if (inner == 0 || outer < 0) return outer;
    return int(std::min<long>(long(outer) * inner, 1L << 30));
}

/// The first member that changes its length; null where there is none.
const StructMember* Lowering::openMember(Type t) const {
    for (const StructMember& m : structOf(t).members) {
        if (m.type.array < 0) return &m;
        if (const StructMember* inside = isStruct(m.type) ? openMember({m.type.base, 0}) : nullptr) return inside;
    }
    return nullptr;
}

/// Whether there can be such an array of structures; if not, that is reported.
bool Lowering::arrayPossible(Type t, Place place) {
    if (t.array == 0) return true;
    if (const StructMember* open = openMember({t.base, 0})) {
        sources_.report(place, msg::kStructArray(open->name, shown({t.base, 0})),
                        "with a length of its own, as in " + open->name + "[8], there are");
        return false;
    }
    for (const Leaf& l : leaves(t))
        if (l.type.array > limits::kShaderArray) {
            sources_.report(place, msg::kArrayLengthRange(limits::kShaderArray),
                            "this one has " + std::to_string(l.type.array) + " elements of '" + l.member->name + "'");
            return false;
        }
    return true;
}

/// Which of `length` structures an index means: whole, and the nearest that there is. `array` has `each` elements for each of
/// them.
ExprPtr Lowering::bounded(ExprPtr index, int length, const Expr& array, int each) {
    const Place place = index->place;
    if (index->kind == ExprKind::Number && length > 0) {
        const double at = std::trunc(index->number), nearest = std::min(std::max(at, 0.0), double(length - 1));
        if (at != nearest) sources_.report(place, msg::kIndexNearest(fmt::format("{:.9g}", at), length));
        return number(nearest, place);
    }
    ExprPtr last = number(length - 1, place);
    if (length < 0)
        last = joined(ExprOp::Add, wholeStructures(shipped("arraylength", clone(array), place), each), number(-1, place));
    ExprPtr e = shipped("clamp", shipped("floor", std::move(index), place), place);
    adopt(*e, number(0, place));
    adopt(*e, std::move(last));
    return e;
}

/// The element, or with `each` above 0 the slice of so many, that `at` names in an array or a slice.
ExprPtr Lowering::partAt(ExprPtr array, ExprPtr at, int each) {
    const Place place = array->place;
    ExprPtr from = joined(ExprOp::Mul, std::move(at), number(std::max(1, each), place));
    if (isSlice(*array)) {
        from = joined(ExprOp::Add, std::move(array->args[1]), std::move(from));
        array = std::move(array->args[0]);
    }
    ExprPtr e = indexed(std::move(array), std::move(from));
    e->place = place;
    if (each > 0) {
        e->text = kSlice;
        e->number = each;
    }
    return e;
}

/// The elements of an array. Computations that must come first are appended to `pre`.
void Lowering::elements(ExprPtr array, Type type, List& pre, List& out) {
    const Place place = array->place;
    const int n = type.array;
    if (array->kind == ExprKind::ArrayList) {
        List& given = array->args;
        if (int(given.size()) > n) sources_.report(given[size_t(n)]->place, msg::kTooManyElements(given.size(), n));
        const ExprPtr last = array->text == "..." && !given.empty() ? clone(*given.back()) : nullptr;
        for (int k = 0; k < n; ++k) {
            if (k < int(given.size())) out.push_back(std::move(given[size_t(k)]));
            else if (last) out.push_back(clone(*last));
            else out.push_back(isStringLike(type.base) ? node(ExprKind::String, place) : number(0, place));
        }
        return;
    }
    if (!isSlice(*array) && array->kind != ExprKind::Variable) {
        const std::string t = temporary(type, place);
        pre.push_back(assign(variable(t, place), std::move(array), place));
        array = variable(t, place);
    }
    for (int k = 0; k < n; ++k) out.push_back(partAt(clone(*array), number(k, place), 0));
}

/// A slice as the list of its values; other expressions are returned as they are.
ExprPtr Lowering::whole(ExprPtr e) {
    if (!e || !isSlice(*e)) return e;
    auto list = node(ExprKind::ArrayList, e->place);
    for (int k = 0; k < int(e->number); ++k) adopt(*list, partAt(clone(*e), number(k, e->place), 0));
    return list;
}

/// left = right of one leaf: element by element where the left side is a slice.
void Lowering::store(ExprPtr left, ExprPtr right, Base base, Place place, List& pre) {
    if (!isSlice(*left)) {
        pre.push_back(assign(std::move(left), whole(std::move(right)), place));
        return;
    }
    const int n = int(left->number);
    List values;
    elements(std::move(right), {base, n}, pre, values);
    for (int k = 0; k < n; ++k)
        pre.push_back(assign(partAt(clone(*left), number(k, place), 0), std::move(values[size_t(k)]), place));
}

/// A member of a structure that is an array of no structures.
const StructMember* Lowering::arrayMember(const Expr& e) const {
    if (e.kind != ExprKind::Member) return nullptr;
    const Type t = typeOf(*e.args[0]);
    const StructMember* m = isStruct(t) && !t.array ? member(t, e.text) : nullptr;
    return m && m->type.array && !isStruct(m->type) ? m : nullptr;
}

/// Expressions that are about an array that one of many structures has. False: it is none of them, and nothing is done.
bool Lowering::rewriteArray(ExprPtr& e) {
    List pre, out;
    const Place place = e->place;
    if (e->kind == ExprKind::Index) {
        const StructMember* m = arrayMember(*e->args[0]);
        if (!m) return false;
        methodCall(*e->args[0]);
        pick(*e->args[0], pre, out);
        rewrite(e->args[1]);
        if (isSlice(*out[0])) {
            ExprPtr at = bounded(std::move(e->args[1]), m->type.array, *out[0], 1);
            e = partAt(std::move(out[0]), std::move(at), 0);
            e->place = place;
        } else {
            ExprPtr at = std::move(e->args[1]);
            e->args.clear();
            adopt(*e, std::move(out[0]));
            adopt(*e, std::move(at));
        }
        sequence(e, std::move(pre));
        return true;
    }
    if (e->kind == ExprKind::Assign && e->op == ExprOp::Assign && arrayMember(*e->args[0]) && inArray(*e->args[0]->args[0])) {
        const Type type = arrayMember(*e->args[0])->type;
        pick(*e->args[0], pre, out);
        rewrite(e->args[1]);
        if (e->args[1]->kind != ExprKind::Variable) { // it may read what is written
            const std::string t = temporary(type, place);
            pre.push_back(assign(variable(t, place), std::move(e->args[1]), place));
            e->args[1] = variable(t, place);
        }
        store(std::move(out[0]), std::move(e->args[1]), type.base, place, pre);
        e = std::move(pre.back());
        pre.pop_back();
        sequence(e, std::move(pre));
        return true;
    }
    return false;
}

/// Is it an element of an array, or inside of one?
bool Lowering::inArray(const Expr& e) {
    return e.kind == ExprKind::Index || ((e.kind == ExprKind::Member) && inArray(*e.args[0]));
}

/// May the function change that argument?
bool Lowering::putsOut(const std::string& function, size_t arguments, size_t i) const {
    const auto [from, to] = functions_.equal_range(function);
    for (auto f = from; f != to; ++f)
        if (f->second.parameters.size() == arguments && f->second.outputs[i]) return true;
    return false;
}

/// A part of an argument: of a slice its values; where they are put out a variable that takes them, from which `after` has them
/// back.
ExprPtr Lowering::argument(ExprPtr part, Type type, bool output, List& pre, List& after) {
    if (!isSlice(*part)) return part;
    if (!output) return whole(std::move(part));
    const Place place = part->place;
    const std::string t = temporary({type.base, int(part->number)}, place);
    pre.push_back(assign(variable(t, place), whole(clone(*part)), place));
    store(std::move(part), variable(t, place), type.base, place, after);
    return variable(t, place);
}

/// push(a, value), resize(a, n), reserve(a, n) of structures.
void Lowering::changeLength(Expr& e, List& pre) {
    const Type t = typeOf(*e.args[0]);
    const auto all = leaves({t.base, 0});
    const bool pushes = e.text == "push";
    List arrays, values;
    flatten(std::move(e.args[0]), pre, arrays);
    if (pushes) valueOf(std::move(e.args[1]), {t.base, 0}, pre, values);
    else rewrite(e.args[1]);
    if (!pushes && arrays.size() > 1 && e.args[1]->kind != ExprKind::Number && e.args[1]->kind != ExprKind::Variable) {
        const std::string length = temporary({Base::Float, 0}, e.place); // computed once
        pre.push_back(assign(variable(length, e.place), std::move(e.args[1]), e.place));
        e.args[1] = variable(length, e.place);
    }
    const auto call = [&](const Expr& array, ExprPtr value) {
        auto one = node(ExprKind::ShadeopCall, e.place);
        one->text = e.text;
        adopt(*one, clone(array));
        adopt(*one, std::move(value));
        pre.push_back(std::move(one));
    };
    for (size_t i = 0; i < arrays.size() && (!pushes || i < values.size()); ++i) {
        const int each = all[i].type.array;
        if (!pushes) {
            ExprPtr n = clone(*e.args[1]); // whole structures
            if (n->kind == ExprKind::Number) n->number = std::floor(n->number);
            else if (each) n = shipped("floor", std::move(n), e.place);
            call(*arrays[i], each ? joined(ExprOp::Mul, std::move(n), number(each, e.place)) : std::move(n));
            continue;
        }
        List parts;
        if (each) elements(std::move(values[i]), all[i].type, pre, parts);
        else parts.push_back(std::move(values[i]));
        for (ExprPtr& p : parts) call(*arrays[i], std::move(p));
    }
}

/// pop(a) of structures: the last of each leaf.
void Lowering::popLast(Expr& e, Type type, List& pre, List& out) {
    const Place place = e.place;
    const std::string t = temporary(type, place);
    List arrays;
    flatten(std::move(e.args[0]), pre, arrays);
    const auto all = leaves(type);
    for (size_t i = 0; i < all.size() && i < arrays.size(); ++i) {
        const ExprPtr to = variable(t + all[i].path, place);
        for (int k = std::max(1, all[i].type.array); k-- > 0;) {
            auto call = node(ExprKind::ShadeopCall, place);
            call->text = "pop";
            adopt(*call, clone(*arrays[i]));
            pre.push_back(assign(all[i].type.array ? indexed(clone(*to), number(k, place)) : clone(*to), std::move(call), place));
        }
        out.push_back(clone(*to));
    }
}

/// arraylength(a), capacity(a) of structures.
void Lowering::measure(ExprPtr& e, List& pre) {
    const auto all = leaves({typeOf(*e->args[0]).base, 0});
    const int length = typeOf(*e->args[0]).array;
    List parts;
    flatten(std::move(e->args[0]), pre, parts);
    if (!parts.empty() && isSlice(*parts[0])) { // of one of many structures: it does not change
        e = number(length, e->place);
        return;
    }
    size_t best = 0; // the member that has no room for more first
    for (size_t i = 0; i < parts.size(); ++i)
        if (all[i].type.array > all[best].type.array) best = i;
    e->args[0] = parts.empty() ? variable("", e->place) : whole(std::move(parts[best]));
    if (!parts.empty()) e = wholeStructures(std::move(e), std::max(1, all[best].type.array));
}

/// {a, b, ...} for an array of structures, one list for each leaf.
void Lowering::listOf(Expr& e, Type want, List& pre, List& out) {
    const auto all = leaves({want.base, 0});
    if (want.array > 0 && e.args.size() > size_t(want.array)) {
        sources_.report(e.args[size_t(want.array)]->place, msg::kTooManyElements(e.args.size(), want.array));
        e.args.resize(size_t(want.array));
    }
    List lists;
    for (size_t i = 0; i < all.size(); ++i) {
        lists.push_back(node(ExprKind::ArrayList, e.place));
        if (e.text == "{}" || all[i].type.array == 0) lists.back()->text = e.text;
    }
    for (auto& a : e.args) {
        List parts;
        valueOf(std::move(a), {want.base, 0}, pre, parts);
        for (size_t i = 0; i < all.size() && i < parts.size(); ++i) {
            List values;
            if (all[i].type.array) elements(std::move(parts[i]), all[i].type, pre, values);
            else values.push_back(std::move(parts[i]));
            for (auto& v : values) adopt(*lists[i], std::move(v));
        }
    }
    for (size_t i = 0; i < all.size(); ++i) {
        const size_t each = size_t(all[i].type.array), full = each * size_t(std::max(0, want.array));
        if (each && e.text == "...") // the last structure again for the rest
            while (lists[i]->args.size() >= each && lists[i]->args.size() < full)
                adopt(*lists[i], clone(*lists[i]->args[lists[i]->args.size() - each]));
        out.push_back(std::move(lists[i]));
    }
}

} // namespace alpenglow::rsl::front

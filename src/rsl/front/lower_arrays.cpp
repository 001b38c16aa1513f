// Arrays of structures that hold arrays: a member of n elements in an array of m structures is one array of m * n. What one
// structure has of it is a slice, an Index node with `text` "slice", args the variable and where it begins, `number` its length;
// no slice is left when the pass is done.
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/lower.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace alpenglow::rsl::front {

namespace {

constexpr const char* kSlice = "slice";

/// a + b, a * b; of two numbers the number.
ExprPtr joined(ExprOp op, ExprPtr a, ExprPtr b) {
    if (a->kind == ExprKind::Number && b->kind == ExprKind::Number)
        return floatOf(op == ExprOp::Add   ? a->number + b->number
                       : op == ExprOp::Mul ? a->number * b->number
                                           : a->number / b->number,
                       a->place);
    if (op == ExprOp::Add && a->kind == ExprKind::Number && a->number == 0) return b;
    if (op == ExprOp::Add && b->kind == ExprKind::Number && b->number == 0) return a;
    auto e = node(ExprKind::Binary, a->place, op);
    e->type = kNumber;
    adopt(*e, std::move(a));
    adopt(*e, std::move(b));
    inferFromOperands(*e);
    return e;
}

/// A call of a function of the renderer, in the form that takes these types.
ExprPtr shipped(const char* name, std::vector<ExprPtr> args, Place place) {
    auto e = node(ExprKind::ShadeopCall, place);
    e->text = name;
    e->shadeop = findShadeop(name);
    for (auto& a : args) adopt(*e, std::move(a));
    const auto fits = [&](const Signature& s) {
        bool same = s.parameters.size() == e->args.size();
        for (size_t i = 0; same && i < e->args.size(); ++i) {
            const Type have = storedType(e->args[i]->type), want = s.parameters[i].type;
            same = have.base == want.base && (have.array != 0) == (want.array != 0);
        }
        return same;
    };
    const auto s = std::ranges::find_if(e->shadeop->signatures, fits);
    if (s == e->shadeop->signatures.end()) return e; // of an argument that is wrong
    e->signature = &*s;
    e->type = s->result;
    inferFromOperands(*e);
    return e;
}

template <class... A> ExprPtr shipped(const char* name, Place place, A... args) {
    std::vector<ExprPtr> all;
    (all.push_back(std::move(args)), ...);
    return shipped(name, std::move(all), place);
}

ExprPtr lengthOf(const char* function, ExprPtr array, Place place) {
    ExprPtr e = shipped(function, place, std::move(array));
    e->varying = false; // a length is that of all points
    return e;
}

/// The number of whole structures in so many elements, `each` per structure. Values of a scene may end within one.
ExprPtr wholeStructures(ExprPtr elements, int each) {
    const Place place = elements->place;
    return each == 1 ? std::move(elements)
                     : shipped("floor", place, joined(ExprOp::Div, std::move(elements), floatOf(each, place)));
}

ExprPtr indexed(ExprPtr array, ExprPtr at) {
    auto e = node(ExprKind::Index, array->place);
    e->type = array->type.element();
    adopt(*e, std::move(array));
    adopt(*e, std::move(at));
    inferFromOperands(*e);
    return e;
}

} // namespace

ExprPtr zeroOf(Base base, Place place) {
    if (isStringLike(base)) {
        auto e = node(ExprKind::String, place);
        e->handle = base == Base::Shader;
        e->type = {base, 0};
        e->varying = false;
        return e;
    }
    ExprPtr zero = floatOf(0, place);
    if (base == Base::Float) return zero;
    auto e = node(ExprKind::Cast, place);
    e->type = {base, 0};
    adopt(*e, std::move(zero));
    inferFromOperands(*e);
    return e;
}

bool Lowering::isSlice(const Expr& e) { return e.kind == ExprKind::Index && e.text == kSlice; }

/// Which of `length` structures an index means: whole, and the nearest that there is. `array` has `each` elements for each of
/// them.
ExprPtr Lowering::bounded(ExprPtr index, int length, const Expr& array, int each) {
    const Place place = index->place;
    if (index->kind == ExprKind::Number && length > 0) {
        const double at = std::trunc(index->number), nearest = std::min(std::max(at, 0.0), double(length - 1));
        if (at != nearest) sources_.report(place, msg::kIndexNearest(fmt::format("{:.9g}", at), length));
        return floatOf(nearest, place);
    }
    ExprPtr last = floatOf(length - 1, place);
    if (length < 0)
        last = joined(ExprOp::Add, wholeStructures(lengthOf("arraylength", clone(array), place), each), floatOf(-1, place));
    return shipped("clamp", place, shipped("floor", place, std::move(index)), floatOf(0, place), std::move(last));
}

/// The element, or with `each` above 0 the slice of so many, that `at` names in an array or a slice.
ExprPtr Lowering::partAt(ExprPtr array, ExprPtr at, int each) {
    const Place place = array->place;
    const Base base = array->type.base;
    ExprPtr from = joined(ExprOp::Mul, std::move(at), floatOf(std::max(1, each), place));
    if (isSlice(*array)) {
        from = joined(ExprOp::Add, std::move(array->args[1]), std::move(from));
        array = std::move(array->args[0]);
    }
    ExprPtr e = indexed(std::move(array), std::move(from));
    e->place = place;
    e->type = {base, each};
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
        const ExprPtr last = array->text == "..." && !given.empty() ? clone(*given.back()) : nullptr;
        for (int k = 0; k < n; ++k) {
            if (k < int(given.size())) out.push_back(std::move(given[size_t(k)]));
            else if (last) out.push_back(clone(*last));
            else out.push_back(zeroOf(type.base, place));
        }
        return;
    }
    if (!isSlice(*array) && array->kind != ExprKind::Variable) {
        Symbol* t = temporary(type, place)[0];
        pre.push_back(assign(use(t, place), std::move(array), place));
        array = use(t, place);
    }
    for (int k = 0; k < n; ++k) out.push_back(partAt(clone(*array), floatOf(k, place), 0));
}

/// A slice as the list of its values; other expressions are returned as they are.
ExprPtr Lowering::whole(ExprPtr e) {
    if (!e || !isSlice(*e)) return e;
    auto list = node(ExprKind::ArrayList, e->place);
    list->type = e->type;
    for (int k = 0; k < int(e->number); ++k) adopt(*list, partAt(clone(*e), floatOf(k, e->place), 0));
    inferFromOperands(*list);
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
        pre.push_back(assign(partAt(clone(*left), floatOf(k, place), 0), std::move(values[size_t(k)]), place));
}

/// Expressions that are about an array that a structure has. False: it is none of them, and nothing is done.
bool Lowering::rewriteArray(ExprPtr& e) {
    const auto arrayMember = [&](Expr& x) { return x.kind == ExprKind::Part && typed(x) && x.type.array && !isStruct(x.type); };
    List pre, out;
    const Place place = e->place;
    if (e->kind == ExprKind::Index) {
        if (!arrayMember(*e->args[0])) return false;
        const int length = e->args[0]->type.array;
        pick(*e->args[0], pre, out);
        rewrite(e->args[1]);
        if (isSlice(*out[0])) {
            ExprPtr at = bounded(std::move(e->args[1]), length, *out[0], 1);
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
        const Type type = e->args[0]->type;
        pick(*e->args[0], pre, out);
        rewrite(e->args[1]);
        unroll(e->args[1], pre);
        if (e->args[1]->kind != ExprKind::Variable) { // it may read what is written
            Symbol* t = temporary(type, place)[0];
            pre.push_back(assign(use(t, place), std::move(e->args[1]), place));
            e->args[1] = use(t, place);
        }
        store(std::move(out[0]), std::move(e->args[1]), type.base, place, pre);
        e = std::move(pre.back());
        pre.pop_back();
        sequence(e, std::move(pre));
        return true;
    }
    return false;
}

/// A part of an argument: of a slice its values; where they are put out a variable that takes them, from which `after` has them
/// back.
ExprPtr Lowering::argument(ExprPtr part, Type type, bool output, List& pre, List& after) {
    if (!isSlice(*part)) return part;
    if (!output) return whole(std::move(part));
    const Place place = part->place;
    Symbol* t = temporary({type.base, int(part->number)}, place)[0];
    pre.push_back(assign(use(t, place), whole(clone(*part)), place));
    store(std::move(part), use(t, place), type.base, place, after);
    return use(t, place);
}

/// push(a, value), resize(a, n), reserve(a, n) of structures. False: it is none of them.
bool Lowering::changeLength(Expr& e, List& pre) {
    if (e.args.size() != 2 || !isStruct(e.args[0]->type) || !e.args[0]->type.array) return false;
    const Type array = e.args[0]->type;
    const std::vector<Leaf> all = leaves(array.element());
    const bool pushes = e.text == "push";
    List arrays, values;
    flatten(std::move(e.args[0]), array, pre, arrays);
    if (pushes) valueOf(std::move(e.args[1]), array.element(), pre, values);
    else rewrite(e.args[1]);
    if (!pushes && arrays.size() > 1 && e.args[1]->kind != ExprKind::Number && e.args[1]->kind != ExprKind::Variable) {
        Symbol* length = temporary(kNumber, e.place)[0]; // computed once
        pre.push_back(assign(use(length, e.place), std::move(e.args[1]), e.place));
        e.args[1] = use(length, e.place);
    }
    const auto call = [&](const Expr& of, ExprPtr value) {
        pre.push_back(shipped(e.text.c_str(), e.place, clone(of), std::move(value)));
    };
    for (size_t i = 0; i < arrays.size() && i < all.size() && (!pushes || i < values.size()); ++i) {
        const int each = all[i].type.array;
        if (!pushes) {
            ExprPtr n = clone(*e.args[1]); // whole structures
            if (n->kind == ExprKind::Number) n->number = std::floor(n->number);
            else if (each) n = shipped("floor", e.place, std::move(n));
            call(*arrays[i], each ? joined(ExprOp::Mul, std::move(n), floatOf(each, e.place)) : std::move(n));
            continue;
        }
        List parts;
        if (each) elements(std::move(values[i]), all[i].type, pre, parts);
        else parts.push_back(std::move(values[i]));
        for (ExprPtr& p : parts) call(*arrays[i], std::move(p));
    }
    return true;
}

/// pop(a) of structures: the last of each leaf.
void Lowering::popLast(Expr& e, List& pre, List& out) {
    const Place place = e.place;
    const Type type = e.type, array = e.args[0]->type;
    const Symbols t = temporary(type, place);
    List arrays;
    flatten(std::move(e.args[0]), array, pre, arrays);
    const std::vector<Leaf> all = leaves(type);
    for (size_t i = 0; i < all.size() && i < arrays.size(); ++i) {
        for (int k = std::max(1, all[i].type.array); k-- > 0;) {
            ExprPtr last = shipped("pop", place, clone(*arrays[i]));
            last->type = all[i].type.element(); // a handle, too
            ExprPtr to = use(t[i], place);
            if (all[i].type.array) to = indexed(std::move(to), floatOf(k, place));
            pre.push_back(assign(std::move(to), std::move(last), place));
        }
        out.push_back(use(t[i], place));
    }
}

/// arraylength(a), capacity(a) of structures.
void Lowering::measure(ExprPtr& e, List& pre) {
    const Type array = e->args[0]->type;
    const std::vector<Leaf> all = leaves(array.element());
    const Place place = e->place;
    List parts;
    flatten(std::move(e->args[0]), array, pre, parts);
    if (!parts.empty() && isSlice(*parts[0])) { // of one of many structures: it does not change
        e = floatOf(array.array, place);
        return;
    }
    if (parts.empty()) {
        e = floatOf(0, place);
        return;
    }
    size_t best = 0; // the member that has no room for more first
    for (size_t i = 0; i < parts.size() && i < all.size(); ++i)
        if (all[i].type.array > all[best].type.array) best = i;
    const std::string name = e->text;
    e = wholeStructures(lengthOf(name.c_str(), whole(std::move(parts[best])), place), std::max(1, all[best].type.array));
}

/// {a, b, ...} for an array of structures, one list for each leaf.
void Lowering::listOf(Expr& e, List& pre, List& out) {
    const Type want = e.type;
    const std::vector<Leaf> all = leaves(want.element());
    List lists;
    for (const Leaf& l : all) {
        lists.push_back(node(ExprKind::ArrayList, e.place));
        if (e.text == "{}" || l.type.array == 0) lists.back()->text = e.text;
    }
    for (auto& a : e.args) {
        List parts;
        valueOf(std::move(a), want.element(), pre, parts);
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
        const int fixed = Structures::flatLength(want.array, all[i].type.array);
        lists[i]->type = {all[i].type.base, fixed > 0 ? fixed : std::max(1, int(lists[i]->args.size()))};
        inferFromOperands(*lists[i]);
        out.push_back(std::move(lists[i]));
    }
}

} // namespace alpenglow::rsl::front

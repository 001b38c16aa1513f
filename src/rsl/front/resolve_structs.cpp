// Top down, structures: the reading that is wanted, with all members of constructors and all conversions to the structures that
// others extend in the tree.
#include "rsl/front/checker.h"
#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/structs.h"
#include <algorithm>

namespace alpenglow::rsl::front {

namespace {

ExprPtr untypedZero(Base base, Place place) {
    ExprPtr z = node(isStringLike(base) ? ExprKind::String : ExprKind::Number, place);
    z->handle = base == Base::Shader;
    return z;
}

} // namespace

/// The value of a structure, or of an array of them, where the shader gives none.
ExprPtr Checker::defaultOf(Type t, Place place) const {
    auto one = node(ExprKind::Construct, place);
    one->type = t.element();
    if (!t.array) return one;
    auto list = node(ExprKind::ArrayList, place);
    if (t.array > 0 && structures_.hasDefaults(t)) list->text = "...";
    adopt(*list, std::move(one));
    return list;
}

/// The value of a member that a constructor leaves out.
ExprPtr Checker::defaultOf(const StructMember& m, Place place) const {
    if (m.init) return clone(*m.init);
    if (isStruct(m.type)) return defaultOf(m.type, place);
    if (!m.type.array) return untypedZero(m.type.base, place);
    auto list = node(ExprKind::ArrayList, place);
    adopt(*list, untypedZero(m.type.base, place));
    return list;
}

/// Name(a, b, ...): all members, the missing ones by their defaults.
void Checker::resolveConstruct(Expr& e, Type type) {
    const auto& members = structures_.of(type).members;
    if (e.args.size() > members.size()) { // {a, b, ...}
        sources_.report(e.place, msg::kStructMemberCount(structures_.shown(type), members.size(), e.args.size()));
        e.args.resize(members.size());
    }
    for (size_t i = 0; i < members.size(); ++i) {
        if (i == e.args.size()) {
            adopt(e, defaultOf(members[i], e.place));
            infer(*e.args[i]);
        }
        Type t = members[i].type;
        resolveInitial(e.args[i], t);
        e.height = std::max(e.height, e.args[i]->height + 1);
    }
    e.type = type;
    finish(e);
}

/// {a, b, ...} for an array of structures.
void Checker::resolveStructures(Expr& e, Type want) {
    if (want.array > 0 && e.args.size() > size_t(want.array)) {
        sources_.report(e.args[size_t(want.array)]->place, msg::kTooManyElements(e.args.size(), want.array));
        e.args.resize(size_t(want.array));
    }
    for (auto& a : e.args) {
        resolveStructure(a, want.element());
        e.height = std::max(e.height, a->height + 1);
    }
    e.type = want;
    finish(e);
}

/// push(), pop(), resize(), reserve(), arraylength() and capacity() of an array of structures.
void Checker::resolveArrayCall(Expr& e) {
    const Type array = infos_.at(e.args[0].get()).array;
    resolveStructure(e.args[0], array);
    if (e.text == "push") resolveStructure(e.args[1], array.element());
    else if (e.args.size() == 2) resolveTypes(e.args[1], {Base::Float, 0});
    const bool measures = e.text == "arraylength" || e.text == "capacity";
    e.type = e.text == "pop" ? array.element() : Type{measures ? Base::Float : Base::Void, 0};
    finish(e);
    if (!measures) changesLength(*e.args[0]);
    else e.varying = false;
}

/// Reports an array whose length does not change.
void Checker::changesLength(const Expr& array) {
    const Symbol* s = array.kind == ExprKind::Variable ? array.symbol : nullptr;
    const bool open = s ? s->resizable || (s->origin == Symbol::Origin::FunctionParameter && s->type.array == -1)
                        : array.type.array < 0 || array.kind != ExprKind::Part;
    if (open || (s && s->type.base == Base::Void)) return;
    const std::string name = pathText(array);
    sources_.report(array.place, msg::kFixedLength(name),
                    !s || s->origin == Symbol::Origin::Local
                        ? "declare it as " + structures_.text(array.type.element()) + " " + name + "[]"
                        : "only local arrays and parameters of functions can change theirs");
}

/// A member of a structure.
void Checker::resolvePart(Expr& e) {
    resolveStructure(e.args[0], structureOf(infos_.at(e.args[0].get())));
    const Type of = e.args[0]->type;
    const StructMember* m = structures_.member(of, e.text);
    if (!m) return; // what it is a member of is wrong, as was reported
    e.type = {m->type.base, Structures::flatLength(of.array, m->type.array), m->type.structure};
    e.varying = false;
    const Expr* root = &e;
    for (; (root->kind == ExprKind::Part || root->kind == ExprKind::Index) && !root->args.empty(); root = root->args[0].get())
        if (root->kind == ExprKind::Index) e.varying |= root->args[1]->varying;
    e.varying |= root->kind == ExprKind::Variable ? storageOf(e) != Storage::Uniform : root->varying;
}

/// Of a member of a variable: as the variable is declared, else its own, else that of the nearest member around it.
Storage Checker::storageOf(const Expr& part) const {
    const Expr* root = &part;
    Storage own = Storage::Unspecified;
    for (; root->kind != ExprKind::Variable && !root->args.empty(); root = root->args[0].get()) {
        if (root->kind != ExprKind::Part || own != Storage::Unspecified) continue;
        if (const StructMember* m = structures_.member(root->args[0]->type, root->text)) own = m->storage;
    }
    const Symbol* s = root->kind == ExprKind::Variable ? root->symbol : nullptr;
    if (!s) return Storage::Varying;
    if (s->storage != Storage::Unspecified) return s->storage;
    if (own != Storage::Unspecified) return own;
    const bool uniform = s->origin == Symbol::Origin::ShaderParameter || isStringLike(part.type.base);
    return uniform ? Storage::Uniform : Storage::Varying;
}

/// An element of an array of structures.
void Checker::resolveElement(Expr& e) {
    resolveStructure(e.args[0], infos_.at(e.args[0].get()).array);
    resolveTypes(e.args[1], {Base::Float, 0});
    e.type = e.args[0]->type.element();
    finish(e);
}

/// Brings the expression to that structure or array of structures. What is wrong keeps the type void.
void Checker::resolveStructure(ExprPtr& e, Type want) {
    Info& info = infos_.at(e.get());
    if (info.any) return;
    if (costToStructure(*e, want) >= kNever && e->kind != ExprKind::ArrayList) {
        if (isStructure(info))
            sources_.report(e->place, msg::kStructOther(structures_.shown(want), structures_.shown(structureOf(info))));
        else sources_.report(e->place, msg::kStructValue(structures_.shown(want)));
        info.any = true;
        return;
    }
    resolveStructureKind(e, want);
    if (!isStruct(e->type) || e->type.structure == want.structure) return;
    convert(e, {Base::Struct, e->type.array, want.structure});
}

void Checker::resolveStructureKind(ExprPtr& e, Type want) {
    switch (e->kind) {
    case ExprKind::ArrayList:
        if (want.array) return resolveStructures(*e, want);
        e->kind = ExprKind::Construct;
        return resolveConstruct(*e, want);
    case ExprKind::Construct:
        return resolveConstruct(*e, e->type.element());
    case ExprKind::Variable:
        e->type = e->symbol->type;
        e->varying = e->symbol->storage != Storage::Uniform;
        return;
    case ExprKind::Index:
        return resolveElement(*e);
    case ExprKind::Part:
        return resolvePart(*e);
    case ExprKind::Conditional:
        if (want.array < 0 || structures_.openMember(want)) // which length would it have?
            sources_.report(e->place, msg::kBadAlternatives(describe(*e->args[1]), describe(*e->args[2])));
        resolveCondition(e->args[0]);
        resolveStructure(e->args[1], want);
        resolveStructure(e->args[2], want);
        e->type = want;
        return finish(*e);
    case ExprKind::Assign: {
        const Type left = structureOf(infos_.at(e->args[0].get()));
        resolveStructure(e->args[0], left);
        resolveStructure(e->args[1], left);
        e->type = left;
        finish(*e);
        return written(*e->args[0]);
    }
    case ExprKind::Cast:
        resolveStructure(e->args[0], e->type);
        return finish(*e);
    case ExprKind::ShadeopCall:
        return isArrayCall(*e) ? resolveArrayCall(*e) : resolveCall(e, want);
    case ExprKind::Method:
        resolveHandle(e, Base::Struct);
        e->type = want;
        return;
    default:
        return;
    }
}

} // namespace alpenglow::rsl::front

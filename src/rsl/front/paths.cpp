#include "rsl/front/paths.h"
#include <algorithm>

namespace alpenglow::rsl::front {

const std::vector<Leaf>& Paths::members(Type t) const {
    const auto [at, fresh] = members_.try_emplace({t.structure, t.array});
    if (fresh && isStruct(t)) at->second = structures_.leaves(t);
    return at->second;
}

std::optional<Path> Paths::of(const Expr& e) const {
    if (e.kind == ExprKind::Variable) {
        if (!e.symbol) return std::nullopt;
        Path p{e.symbol, e.place, e.symbol->type, 0, 1, 1, e.symbol->name};
        if (isStruct(p.type)) p.count = p.named = members(p.type).size();
        return p;
    }
    const bool chooses = e.kind == ExprKind::Index || e.kind == ExprKind::Part || (e.kind == ExprKind::Cast && isStruct(e.type));
    if (!chooses || e.args.empty() || !e.args[0]) return std::nullopt;
    auto p = of(*e.args[0]);
    if (!p) return p;
    if (e.kind == ExprKind::Index) {
        p->type.array = 0;
        p->whole = false;
        return p;
    }
    if (!isStruct(p->type)) return std::nullopt;
    if (e.kind == ExprKind::Cast) {
        p->type.structure = e.type.structure;
        p->count = members(e.type.element()).size(); // those of the structure that is extended come first
        return p;
    }
    size_t at = p->first;
    for (const StructMember& m : structures_.of(p->type).members) {
        const size_t plain = isStruct(m.type) ? members(m.type.element()).size() : 1;
        if (m.name == e.text) {
            p->first = at;
            p->count = p->named = plain;
            p->type = {m.type.base, Structures::flatLength(p->type.array, m.type.array), m.type.structure};
            p->name += "->" + m.name;
            return p;
        }
        at += plain;
    }
    return std::nullopt;
}

std::string Paths::memberName(const Symbol& s, size_t member) const {
    const auto& all = members(s.type);
    return member < all.size() ? s.name + all[member].path : s.name;
}

Type Paths::memberType(const Symbol& s, size_t member) const {
    const auto& all = members(s.type);
    return member < all.size() ? all[member].type : s.type;
}

Storage Paths::memberStorage(const Symbol& s, size_t member) const {
    const auto& all = members(s.type);
    if (s.storage != Storage::Unspecified || member >= all.size()) return s.storage;
    if (all[member].storage != Storage::Unspecified) return all[member].storage;
    const bool uniform = s.origin == Symbol::Origin::ShaderParameter || isStringLike(all[member].type.base);
    return uniform ? Storage::Uniform : Storage::Varying;
}

} // namespace alpenglow::rsl::front

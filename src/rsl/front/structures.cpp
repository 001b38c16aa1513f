#include "rsl/front/structures.h"
#include "rsl/front/structs.h"
#include <algorithm>

namespace alpenglow::rsl::front {

const StructType& Structures::of(Type t) const {
    static const StructType none{};
    return isStruct(t) && t.structure >= 0 && size_t(t.structure) < all_.size() ? all_[size_t(t.structure)] : none;
}

std::string Structures::text(Type t) const {
    if (!isStruct(t)) return toString(t);
    return of(t).name + (t.array ? "[" + (t.array > 0 ? std::to_string(t.array) : "") + "]" : "");
}

std::string Structures::shown(Type t) const { return isStruct(t) ? "structure '" + text(t) + "'" : toString(t); }

int Structures::named(const std::string& name) const {
    const auto i = std::ranges::find(all_, name, &StructType::name);
    return i == all_.end() ? -1 : int(i - all_.begin());
}

const StructMember* Structures::member(Type t, const std::string& name) const {
    const auto& members = of(t).members;
    const auto i = std::ranges::find(members, name, &StructMember::name);
    return i == members.end() ? nullptr : &*i;
}

int Structures::extensions(Type have, Type want) const {
    if (!isStruct(have) || !isStruct(want) || (have.array != 0) != (want.array != 0)) return -1;
    if (have.array != want.array && have.array > 0 && want.array > 0) return -1;
    int steps = 0;
    for (; have.structure != want.structure; ++steps) {
        const int up = of(have).base;
        if (up < 0 || size_t(steps) > all_.size()) return -1;
        have.structure = int16_t(up);
    }
    return steps;
}

std::vector<Leaf> Structures::leaves(Type t) const {
    std::vector<Leaf> all;
    for (const StructMember& m : of(t).members) {
        if (!isStruct(m.type)) {
            all.push_back({"->" + m.name, m.type, m.storage, &m});
            continue;
        }
        for (Leaf l : leaves(m.type.element())) {
            l.path = "->" + m.name + l.path;
            l.type.array = flatLength(m.type.array, l.type.array);
            if (l.storage == Storage::Unspecified) l.storage = m.storage;
            all.push_back(std::move(l));
        }
    }
    for (Leaf& l : all) l.type.array = flatLength(t.array, l.type.array);
    return all;
}

bool Structures::hasDefaults(Type t) const {
    return std::ranges::any_of(of(t).members,
                               [&](const StructMember& m) { return m.init || (isStruct(m.type) && hasDefaults(m.type)); });
}

const StructMember* Structures::openMember(Type t) const {
    for (const StructMember& m : of(t).members) {
        if (m.type.array < 0) return &m;
        if (const StructMember* inside = isStruct(m.type) ? openMember(m.type.element()) : nullptr) return inside;
    }
    return nullptr;
}

int Structures::flatLength(int outer, int inner) {
    if (outer == 0) return inner;
    if (inner == 0 || outer < 0) return outer;
    return int(std::min<long>(long(outer) * inner, 1L << 30));
}

} // namespace alpenglow::rsl::front

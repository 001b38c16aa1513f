// Structures, their members, and the plain variables that replace one variable of a structure.
#include "rsl/front/structs.h"
#include "base/limits.h"
#include "rsl/front/clone.h"
#include "rsl/front/structs_lowering.h"
#include <algorithm>

namespace alpenglow::rsl::front {

void Lowering::run() {
    for (size_t i = 0; i < unit_.structs.size(); ++i) checkType(i);
    methods();
    for (const auto& f : unit_.functions) note(*f);
    for (const auto& s : unit_.shaders)
        for (const auto& f : s->nested) note(*f);
    for (const auto& c : unit_.classes)
        for (const auto& f : c.shader->nested) note(*f);
    for (auto& f : unit_.functions) function(*f);
    for (auto& s : unit_.shaders) shader(*s);
    for (auto& c : unit_.classes) shader(*c.shader);
}

/// Of anything else, after an error, a structure without members.
const StructType& Lowering::structOf(Type t) const {
    static const StructType none{};
    return isStruct(t) ? unit_.structs[size_t(int(t.base) - kFirstStruct)] : none;
}

std::string Lowering::shown(Type t) const {
    if (!isStruct(t)) return toString(t);
    const std::string length = t.array > 0 ? std::to_string(t.array) : "";
    return "structure '" + structOf(t).name + (t.array ? "[" + length + "]" : "") + "'";
}

/// A structure inside itself would have no end; what changes its length has no place in an array of structures.
void Lowering::checkType(size_t index) {
    size_t& all = members_.emplace_back(1);
    for (auto& m : unit_.structs[index].members) {
        if (!isStruct(m.type)) {
            ++all;
            continue;
        }
        const size_t inner = size_t(int(m.type.base) - kFirstStruct);
        if (inner >= index) { // the parser knows only earlier ones; it could be itself after a second definition
            sources_.report(m.place, msg::kStructRecursive);
            m.type = {Base::Float, 0};
        } else if (all + members_[inner] > limits::kStructMembers) {
            sources_.report(m.place, msg::kStructMembers(limits::kStructMembers));
            m.type = {Base::Float, 0};
        } else if (all += members_[inner]; !arrayPossible(m.type, m.place)) {
            m.type.array = 0;
        }
    }
}

void Lowering::note(const Function& f) {
    Result r{f.result, {}, {}};
    for (const Symbol* p : f.parameters) {
        r.parameters.push_back(p->type);
        r.outputs.push_back(p->output);
    }
    functions_.emplace(f.name, std::move(r));
    for (const auto& n : f.nested) note(*n);
}

std::vector<Leaf> Lowering::leaves(Type t) const {
    std::vector<Leaf> all;
    for (const StructMember& m : structOf(t).members) {
        if (!isStruct(m.type)) {
            all.push_back({"->" + m.name, m.type, m.storage, &m});
            continue;
        }
        for (Leaf l : leaves({m.type.base, 0})) {
            l.path = "->" + m.name + l.path;
            l.type.array = flatLength(m.type.array, l.type.array);
            if (l.storage == Storage::Unspecified) l.storage = m.storage;
            all.push_back(l);
        }
    }
    for (Leaf& l : all) l.type.array = flatLength(t.array, l.type.array);
    return all;
}

const StructMember* Lowering::member(Type t, const std::string& name) const {
    for (const StructMember& m : structOf(t).members)
        if (m.name == name) return &m;
    return nullptr;
}

int Lowering::structNamed(const std::string& name) const {
    for (size_t i = 0; i < unit_.structs.size(); ++i)
        if (unit_.structs[i].name == name) return int(i);
    return -1;
}

int Lowering::extensions(Type t, Base base) const {
    if (!isStruct(t)) return -1;
    int steps = 0;
    for (; t.base != base; ++steps) {
        const int up = structOf(t).base;
        if (up < 0) return -1;
        t.base = structBase(size_t(up));
    }
    return steps;
}

/// The name of the function that a method of this structure, or of one that it extends, became; empty if there is none. A method
/// with as many arguments is taken before one that is nearer. "Base::method" is sought from Base on.
std::string Lowering::methodNamed(Type t, const std::string& method, size_t arguments) const {
    std::string name = method, any;
    if (const size_t colon = method.find("::"); colon != std::string::npos) {
        const int from = structNamed(method.substr(0, colon));
        if (from < 0 || !derives(t, structBase(size_t(from)))) return "";
        t = {structBase(size_t(from)), 0};
        name = method.substr(colon + 2);
    }
    for (;;) {
        std::string full = structOf(t).name + "->" + name;
        const auto [begin, end] = functions_.equal_range(full);
        for (auto f = begin; f != end; ++f)
            if (f->second.parameters.size() == arguments + 1) return full;
        if (begin != end && any.empty()) any = full;
        if (structOf(t).base < 0) return any;
        t = {structBase(size_t(structOf(t).base)), 0};
    }
}

bool Lowering::accepts(const Result& f, const List& given, const std::vector<Type>& types) const {
    if (f.parameters.size() != given.size()) return false;
    for (size_t i = 0; i < given.size(); ++i) {
        const Type t = types[i], p = f.parameters[i];
        if (isStruct(t) ? !derives(t, p.base) : isStruct(p) && !isList(*given[i])) return false;
    }
    return true;
}

Type Lowering::resultOf(const std::string& function, const List& given, Base wanted) const {
    const auto [from, to] = functions_.equal_range(function);
    if (std::none_of(from, to, [](const auto& f) { return isStruct(f.second.type); })) return kNone;
    std::vector<Type> types; // once for all functions: an argument may be a call, too
    for (const auto& a : given) types.push_back(typeOf(*a));
    Type first = kNone, some = kNone; // where none fits, the message about the arguments comes later
    for (auto f = from; f != to; ++f) {
        const Type t = f->second.type;
        if (!isStruct(t) || f->second.parameters.size() != given.size()) continue;
        if (some == kNone) some = t;
        if (!accepts(f->second, given, types)) continue;
        if (wanted != Base::Void && derives(t, wanted)) return t;
        if (first == kNone) first = t;
    }
    return first == kNone ? some : first;
}

/// The structure that an expression is, or void.
Type Lowering::typeOf(const Expr& e) const {
    switch (e.kind) {
    case ExprKind::Variable:
        for (size_t i = scopes_.size(); i-- > 0;)
            if (const auto s = scopes_[i].find(e.text); s != scopes_[i].end()) return s->second;
        return kNone;
    case ExprKind::Index: {
        Type t = typeOf(*e.args[0]);
        if (!isStruct(t) || t.array == 0) return kNone;
        return {t.base, 0};
    }
    case ExprKind::Member: {
        const Type t = typeOf(*e.args[0]);
        if (!isStruct(t) || t.array) return kNone;
        const StructMember* m = member(t, e.text);
        return m && isStruct(m->type) ? m->type : kNone;
    }
    case ExprKind::ShadeopCall: {
        if (const int i = structNamed(e.text); i >= 0) return {structBase(size_t(i)), 0};
        if (const Type t = resultOf(e.text, e.args); isStruct(t)) return t;
        if (e.text == "pop" && e.args.size() == 1)
            if (const Type t = typeOf(*e.args[0]); isStruct(t) && t.array) return {t.base, 0};
        return kNone;
    }
    case ExprKind::Method: {
        const Type t = typeOf(*e.args[0]);
        if (!isStruct(t) || t.array) return kNone;
        return resultOf(methodNamed(t, e.text, e.args.size() - 1), e.args);
    }
    case ExprKind::Conditional:
        return typeOf(*e.args[1]);
    case ExprKind::Assign:
        return typeOf(*e.args[0]);
    case ExprKind::Cast:
        return isStruct(e.type) ? e.type : kNone;
    default:
        return kNone;
    }
}

Symbol* Lowering::newSymbol(const std::string& name, Type type, Storage storage, Place place) {
    auto s = std::make_unique<Symbol>();
    s->name = name;
    s->type = type;
    s->storage = storage;
    s->place = place;
    owner_->push_back(std::move(s));
    return owner_->back().get();
}

/// The variables of one variable of a structure; what was declared of it holds for each.
std::vector<Symbol*> Lowering::split(const Symbol& s) {
    std::vector<Symbol*> all;
    if (!arrayPossible(s.type, s.place)) return all;
    const auto of = std::make_shared<StructVariable>(s.name, int(s.type.base) - kFirstStruct, s.type.array);
    for (const Leaf& l : leaves(s.type)) {
        Symbol* n = newSymbol(s.name + l.path, l.type, s.storage == Storage::Unspecified ? l.storage : s.storage, s.place);
        n->origin = s.origin;
        n->output = s.output;
        n->isExtern = s.isExtern;
        n->isConstant = s.isConstant;
        n->of = of;
        all.push_back(n);
    }
    return all;
}

/// A variable with a name that shaders cannot use; it is declared before the statement.
std::string Lowering::temporary(Type type, Place place, Storage storage) {
    const std::string name = "(structure " + std::to_string(++temporaries_) + ")";
    auto d = make(StmtKind::Declare, place);
    if (isStruct(type)) {
        for (const Leaf& l : leaves(type)) {
            d->declarators.push_back({newSymbol(name + l.path, l.type, storage, place), nullptr});
        }
    } else {
        d->declarators.push_back({newSymbol(name, type, storage, place), nullptr});
    }
    before_->push_back(std::move(d));
    return name;
}

void Lowering::spill(List& values, Type type, List& pre, Place place) {
    const std::string t = temporary(type, place);
    const auto all = leaves(type);
    for (size_t i = 0; i < values.size() && i < all.size(); ++i) {
        pre.push_back(assign(variable(t + all[i].path, place), whole(std::move(values[i])), place));
        values[i] = variable(t + all[i].path, place);
    }
}

ExprPtr Lowering::zero(const Leaf& l, Place place) {
    const bool handle = l.type.base == Base::Shader;
    ExprPtr z = node(handle ? ExprKind::Variable : l.type.base == Base::String ? ExprKind::String : ExprKind::Number, place);
    if (handle) z->text = "null";
    if (l.type.array == 0) return z;
    auto list = node(ExprKind::ArrayList, place);
    adopt(*list, std::move(z));
    return list;
}

/// Members without a value.
void Lowering::defaults(Type t, Place place, List& pre, List& out) {
    if (t.array > 0) { // those of one, again and again, in a list for each leaf
        List one;
        defaults({t.base, 0}, place, pre, one);
        const auto all = leaves({t.base, 0});
        if (!arrayPossible(t, place)) return;
        for (size_t i = 0; i < one.size() && i < all.size(); ++i) {
            auto list = node(ExprKind::ArrayList, place);
            List parts;
            if (all[i].type.array) elements(std::move(one[i]), all[i].type, pre, parts);
            else parts.push_back(std::move(one[i])), list->text = "...";
            for (int n = 0; n < (all[i].type.array ? t.array : 1); ++n)
                for (auto& p : parts) adopt(*list, clone(*p));
            out.push_back(std::move(list));
        }
        return;
    }
    for (const StructMember& m : structOf(t).members) {
        if (m.init) {
            ExprPtr e = clone(*m.init);
            valueOf(std::move(e), m.type, pre, out);
        } else if (isStruct(m.type) && (m.type.array == 0 || (m.type.array > 0 && hasDefaults(m.type)))) {
            defaults(m.type, place, pre, out);
        } else if (isStruct(m.type)) {
            for (const Leaf& l : leaves(m.type)) out.push_back(zero(l, place));
        } else {
            out.push_back(zero({"", m.type, m.storage, &m}, place));
        }
    }
}

bool Lowering::hasDefaults(Type t) const {
    for (const StructMember& m : structOf(t).members)
        if (m.init || (isStruct(m.type) && hasDefaults(m.type))) return true;
    return false;
}

void lowerStructs(Unit& u, SourceSet& s) {
    if (!u.structs.empty()) Lowering(u, s).run();
}

} // namespace alpenglow::rsl::front

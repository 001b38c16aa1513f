// Bottom up, structures: which one an expression is, and what cannot be done with it.
#include "base/limits.h"
#include "rsl/front/checker.h"
#include "rsl/front/clone.h"
#include "rsl/front/nodes.h"
#include "rsl/front/structs.h"
#include <algorithm>
#include <set>

namespace alpenglow::rsl::front {

namespace {
constexpr const char* kArrow = "a member is read by '->'";
/// Functions of arrays that take arrays of structures, too.
bool takesStructArrays(const std::string& name) {
    static const std::set<std::string_view> kNames = {"push", "pop", "resize", "reserve", "arraylength", "capacity"};
    return kNames.count(name) > 0;
}
bool withinArray(const Expr& e) { return e.kind == ExprKind::Index || (e.kind == ExprKind::Part && withinArray(*e.args[0])); }
/// Whether the function is a method of a structure, whose first argument is the structure.
bool isStructMethod(const std::string& function) { return function.find("->") != function.npos; }
} // namespace

Type Checker::structureOf(const Info& i) {
    if (isStruct(i.array)) return i.array;
    return i.structure >= 0 ? structType(size_t(i.structure)) : Type{};
}

bool Checker::isStructure(const Info& i) {
    return !i.any && (isStruct(i.array) || (i.structure >= 0 && !i.array.array && cheapest(i) == Base::Void));
}

bool Checker::refuseStructure(const Expr& e) {
    Info& info = infos_.at(&e);
    if (!isStructure(info)) return false;
    sources_.report(e.place, msg::kStructUse(structures_.shown(structureOf(info))), kArrow);
    info.any = true;
    return true;
}

Checker::Info& Checker::inferPlain(Expr& e) {
    Info& info = infer(e);
    refuseStructure(e);
    return info;
}

/// A member of a structure, which `of` is.
void Checker::inferPart(Expr& e, Type of, Info& info) {
    const StructMember* m = of.array && e.kind == ExprKind::Member ? nullptr : structures_.member(of, e.text);
    if (!m) {
        std::vector<std::string> names;
        for (const StructMember& x : structures_.of(of).members) names.push_back(x.name);
        const std::string near = nearestName(e.text, names);
        if (of.array)
            sources_.report(e.place, msg::kStructIsArray(structures_.shown(of.element())),
                            "its elements have members: a[i]->" + e.text);
        else
            sources_.report(e.place, msg::kNoSuchMember(structures_.shown(of), e.text),
                            near.empty() ? "" : "did you mean '" + near + "'?");
        info.any = true;
        return;
    }
    e.kind = ExprKind::Part;
    const Type type{m->type.base, Structures::flatLength(of.array, m->type.array), m->type.structure};
    if (!isStruct(type)) e.place = e.args[0]->place; // of a variable of its own
    if (type.array) info.array = type;
    else if (isStruct(type)) info.structure = type.structure;
    else info.cost[int(type.base)] = 0;
}

/// The name of the function that a method of this structure, or of one that it extends, is; empty if there is none. A method with
/// as many arguments is taken before one that is nearer. "Base::method" is sought from Base on.
std::string Checker::methodNamed(Type t, const std::string& method, size_t arguments) const {
    std::string name = method, any;
    if (const size_t colon = method.find("::"); colon != std::string::npos) {
        const int from = structures_.named(method.substr(0, colon));
        if (from < 0 || structures_.extensions(t, structType(size_t(from))) < 0) return "";
        t = structType(size_t(from));
        name = method.substr(colon + 2);
    }
    for (;;) {
        std::string full = structures_.of(t).name + "->" + name;
        const auto [begin, end] = methods_.equal_range(full);
        for (auto f = begin; f != end; ++f)
            if (f->second->parameters.size() == arguments + 1) return full;
        if (begin != end && any.empty()) any = full;
        const int up = structures_.of(t).base;
        if (up < 0) return any;
        t = structType(size_t(up));
    }
}

/// x->f(a) for a structure x is f(x, a).
void Checker::inferMethod(Expr& e, Type of, Info& info) {
    const std::string name = of.array ? "" : methodNamed(of, e.text, e.args.size() - 1);
    if (!name.empty()) {
        e.kind = ExprKind::ShadeopCall;
        e.text = name;
        return inferCall(e, info, 1);
    }
    for (size_t i = 1; i < e.args.size(); ++i) infer(*e.args[i]);
    info.any = true;
    if (of.array) {
        sources_.report(e.place, msg::kStructIsArray(structures_.shown(of.element())),
                        "its elements have methods: a[i]->" + e.text + "()");
        return;
    }
    std::vector<std::string> names;
    for (Type s = of;; s = structType(size_t(structures_.of(s).base))) {
        const std::string head = structures_.of(s).name + "->";
        for (const auto& [n, f] : methods_)
            if (n.starts_with(head)) names.push_back(n.substr(head.size()));
        if (structures_.of(s).base < 0) break;
    }
    const std::string near = nearestName(e.text, names);
    sources_.report(e.place, msg::kNoSuchMethod(structures_.shown(of), e.text),
                    near.empty() ? "" : "did you mean '" + near + "'?");
}

/// Whether the shader has a function of this name that can be seen here.
bool Checker::hasFunction(const std::string& name) const {
    return std::ranges::any_of(scopes_, [&](const Scope& s) { return s.functions.count(name) > 0; }) ||
           std::ranges::any_of(unit_->functions, [&](const auto& f) { return f->name == name; });
}

bool Checker::isArrayCall(const Expr& e) const {
    if (e.kind != ExprKind::ShadeopCall || e.args.empty() || !takesStructArrays(e.text)) return false;
    const auto first = infos_.find(e.args[0].get());
    return first != infos_.end() && !first->second.any && isStruct(first->second.array);
}

/// Calls that only structures have: constructors, and functions of arrays of them. False: it is none of them, and what cannot be
/// done with structures has been reported.
bool Checker::inferStructureCall(Expr& e, Info& info) {
    if (program_.structs.empty()) return false;
    if (const int s = structures_.named(e.text); s >= 0) {
        const Type type = structType(size_t(s));
        e.kind = ExprKind::Construct;
        e.type = type;
        info.structure = s;
        const size_t members = structures_.of(type).members.size();
        if (e.args.size() <= members) return true;
        sources_.report(e.place, msg::kStructMemberCount(structures_.shown(type), members, e.args.size()));
        info.any = true;
        return true;
    }
    const auto structure = [&](const ExprPtr& a) { return isStructure(infos_.at(a.get())); };
    if (std::ranges::none_of(e.args, structure)) return false;
    const bool two = e.text == "push" || e.text == "resize" || e.text == "reserve";
    if (isArrayCall(e) && e.args.size() == (two ? 2 : 1)) {
        e.shadeop = findShadeop(e.text);
        if (e.text == "pop") info.structure = infos_.at(e.args[0].get()).array.structure;
        else info.cost[int(two ? Base::Void : Base::Float)] = 0;
        return true;
    }
    const Shadeop* op = hasFunction(e.text) ? nullptr : findShadeop(e.text);
    if (!op) return false;
    if (takeApart(e, *op))
        for (auto& a : e.args) infer(*a);
    // A shadeop that shows or stores values of any type, such as printf(): each member would be one.
    const auto any = [](const Signature& s) {
        return std::ranges::any_of(s.parameters, [](const auto& p) { return p.type.base == Base::Void; });
    };
    if (std::ranges::any_of(op->signatures, any))
        for (const auto& a : e.args) refuseStructure(*a);
    return false;
}

static ExprPtr memberOf(const Expr& of, const std::string& name, ExprKind kind = ExprKind::Member) {
    auto m = node(kind, of.place);
    m->text = name;
    adopt(*m, clone(of));
    return m;
}

/// Replaces structures of the library in a call of a shadeop by what the shadeop takes: of a filterregion some members, of
/// samples an array for each member. True: the arguments are others.
bool Checker::takeApart(Expr& e, const Shadeop& op) {
    // "materialsamples", samples: left as they are, since these calls draw no samples of the material.
    static const std::set<std::string_view> kSums = {"directlighting", "diffuselighting", "specularlighting", "indirectspecular"};
    const int region = structures_.named("filterregion"), sample = structures_.named("__radiancesample");
    std::vector<ExprPtr> given = std::move(e.args);
    e.args.clear();
    ExprPtr blur;
    bool changed = false;
    for (auto& a : given) {
        const Type t = infos_.at(a.get()).any ? Type{} : structureOf(infos_.at(a.get()));
        const bool one = isStruct(t) && t.structure == region && !t.array;
        if (!one && !(isStruct(t) && t.structure == sample)) {
            adopt(e, std::move(a));
            continue;
        }
        changed = true;
        if (!one && kSums.count(op.name)) {
            const bool token = e.args.size() > 1 && e.args.back()->kind == ExprKind::String && !e.args.back()->handle;
            if (token) e.args.pop_back();
            continue;
        }
        if (!one) {
            for (const StructMember& m : structures_.of(t).members) adopt(e, memberOf(*a, m.name, ExprKind::Part));
            continue;
        }
        std::vector<const char*> parts = {"centre"};
        if (op.footprint.of == Footprint::Of::Surface) parts = {"s1", "t1", "s2", "t2", "s3", "t3", "s4", "t4"};
        if (op.footprint.corners) parts = {"v1", "v2", "v3", "v4"};
        for (const char* p : parts) adopt(e, memberOf(*a, p));
        if (parts.size() > 1 && !blur) blur = memberOf(*a, "blurred");
    }
    if (blur) {
        auto token = node(ExprKind::String, e.place);
        token->text = "blur";
        adopt(e, std::move(token));
        adopt(e, std::move(blur));
    }
    return changed;
}

/// gather(category, P, region, samples): a direction and the angle about it.
void Checker::gatherRegion(std::vector<ExprPtr>& given) {
    const int region = structures_.named("filterregion");
    for (size_t i = 0; region >= 0 && i < given.size(); ++i) {
        const Info& info = infos_.at(given[i].get());
        if (info.any || info.structure != region || info.array.array) continue;
        ExprPtr angle = memberOf(*given[i], "spread"), centre = memberOf(*given[i], "centre");
        infer(*angle), infer(*centre);
        given[i] = std::move(centre);
        given.insert(given.begin() + long(i) + 1, std::move(angle));
        return;
    }
}

/// What it costs to give the expression for a structure or an array of them; kNever if it cannot be given.
int Checker::costToStructure(const Expr& e, Type want) const {
    const Info& info = infos_.at(&e);
    if (info.any) return 0;
    if (e.kind == ExprKind::ArrayList) {
        const size_t most = want.array > 0   ? size_t(want.array)
                            : want.array < 0 ? e.args.size()
                                             : structures_.of(want).members.size();
        return e.args.size() <= most ? kConversion : kNever;
    }
    if (e.kind == ExprKind::Conditional) return costToStructure(*e.args[1], want); // the other one has a message of its own
    if (e.kind == ExprKind::Method && info.ofHandle) return want.array ? kNever : kConversion;
    int best = kNever;
    const auto one = [&](Type have, int cost) {
        const int steps = structures_.extensions(have, want);
        if (steps >= 0) best = std::min(best, std::min(cost + steps * kConversion, kNever - 1));
    };
    if (info.choices.empty()) one(structureOf(info), 0);
    for (const Choice& c : info.choices) one(c.result, c.cost);
    return best;
}

/// Whether structures are what does not fit in a call: then the first that does not is reported. `functions`: those it could
/// mean.
bool Checker::wrongStructure(const Expr& call, const std::vector<const Function*>& functions) {
    const auto fits = [&](const Expr& a, Type p) {
        const Info& info = infos_.at(&a);
        if (info.any || a.kind == ExprKind::ArrayList) return true;
        const Type have = structureOf(info);
        if (!isStructure(info)) return !isStruct(p) || costToStructure(a, p) < kNever;
        if (!isStruct(p)) return false;
        return costToStructure(a, {p.base, have.array, p.structure}) < kNever; // lengths come later
    };
    const Expr* wrong = nullptr;
    Type wanted;
    bool accepted = false, outputs = true, any = false;
    const auto output = [&](const Function& f, size_t i) { return f.parameters[i]->output; };
    for (const Function* f : functions) {
        if (f->parameters.size() != call.args.size()) continue;
        any = true;
        size_t i = 0;
        while (i < call.args.size() && fits(*call.args[i], f->parameters[i]->type)) ++i;
        accepted |= i == call.args.size();
        if (i == call.args.size() || wrong) continue;
        wrong = call.args[i].get();
        wanted = f->parameters[i]->type;
    }
    if (!accepted && wrong) {
        const Info& info = infos_.at(wrong);
        const std::string have = structures_.shown(structureOf(info));
        if (isStruct(wanted) && isStructure(info))
            sources_.report(wrong->place, msg::kStructOther(structures_.shown(wanted), have));
        else if (isStruct(wanted)) sources_.report(wrong->place, msg::kStructValue(structures_.shown(wanted)));
        else sources_.report(wrong->place, msg::kStructUse(have));
        return true;
    }
    for (size_t i = isStructMethod(call.text); any && i < call.args.size(); ++i) {
        if (!isStructure(infos_.at(call.args[i].get())) || isVariable(*call.args[i])) continue;
        outputs = true;
        for (const Function* f : functions)
            if (f->parameters.size() == call.args.size()) outputs &= output(*f, i);
        if (!outputs) continue;
        sources_.report(call.args[i]->place, msg::kOutputArgument(call.text));
        return true;
    }
    return false;
}

/// left = right for structures. Whether the right side fits is seen when it is resolved.
void Checker::inferStructureAssign(Expr& e, Info& info) {
    const Type t = structureOf(infos_.at(e.args[0].get()));
    if (t.array) info.array = t;
    else info.structure = t.structure;
    info.any = true;
    if (e.op != ExprOp::Assign) sources_.report(e.place, msg::kStructAssigned);
    else if (!isVariable(*e.args[0])) sources_.report(e.place, msg::kNotAssignable);
    else info.any = infos_.at(e.args[1].get()).any;
}

/// The name of a variable or a member of one, as the shader writes it without indices; "" of other expressions.
std::string Checker::pathText(const Expr& e) {
    switch (e.kind) {
    case ExprKind::Variable:
        return e.symbol ? e.symbol->name : e.text;
    case ExprKind::Index:
    case ExprKind::Cast:
        return pathText(*e.args[0]);
    case ExprKind::Part: {
        const std::string of = pathText(*e.args[0]);
        return of.empty() ? "" : of + "->" + e.text;
    }
    default:
        return "";
    }
}

/// Whether constant indices into this member are looked at when structures are taken apart: the nearest element is taken then.
bool Checker::isBounded(const Expr& member) { return member.kind == ExprKind::Part && withinArray(*member.args[0]); }

/// Whether the first argument of the call is what a method is called for, which may be changed whatever it is.
bool Checker::isReceiver(const Expr& call, size_t i) { return i == 0 && isStructMethod(call.text); }

} // namespace alpenglow::rsl::front

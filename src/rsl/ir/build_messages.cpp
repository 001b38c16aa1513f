// Services of the renderer on their way into variables; outputs of the displacement shader; variables of the primitive by any
// name.
#include "base/limits.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <cstdio>

namespace alpenglow::rsl::ir {

/// Adds what the variable takes to the results of a call: of an array all its elements, and before them the length where that
/// changes.
Builder::Receiver Builder::receiver(Site& s, const Expr& to, const std::string& name) {
    Receiver r{&to, 0};
    const auto add = [&](Kind k, const std::string& n) {
        s.resultKinds.push_back(k);
        s.resultNames.push_back(n);
        ++r.rows;
    };
    if (!to.type.array) {
        add(kindOf(to.type), name);
        return r;
    }
    Inst* a = array(to);
    const bool open = lengths(a) != nullptr;
    if (open) add(Kind::Float, lengthResult(name));
    for (int n = 0; n < (open ? a->index : arrayLength(a)); ++n) add(a->element, name + "[" + std::to_string(n) + "]");
    return r;
}

/// `found`: a Bool, null if there is always an answer. A variable without an answer keeps its value.
void Builder::receive(const Receiver& r, std::span<Inst* const> values, Inst* found) {
    const auto either = [&](Inst* v, Inst* old) {
        return found ? emit(Op::Select, v->kind, {found, v, coerce(old, v->kind)}) : v;
    };
    if (!r.to->type.array) {
        const Held held(*this, *r.to);
        assign(*r.to, found ? either(values[0], expr(*r.to)) : values[0]);
        return;
    }
    Inst* a = array(*r.to);
    if (a->op != Op::ArrayNew) return;
    size_t first = 0;
    if (const Lengths* known = lengths(a)) {
        const Lengths l = *known;
        Inst* n = limitLength(a, either(values[first++], get(l.length)));
        set(l.length, n);
        set(l.reserved, runtime1("al_max_f", {get(l.reserved), n}, Kind::Float));
    }
    for (size_t k = first; k < values.size(); ++k) {
        Inst* at = constant(static_cast<float>(k - first));
        emit(Op::ArrayStore, Kind::None, {a, at, either(values[k], found ? emit(Op::ArrayLoad, a->element, {a, at}) : nullptr)});
    }
}

/// displacement() of an output that the displacement shader of the primitive has: KernelOptions::stringParameters says so, as
/// QueriedOutput. It is an input of the
/// kernel then, so that it has derivatives. False: the renderer is asked.
bool Builder::queriedDisplacement(const Expr& call, const std::string& name, Inst*& found) {
    const std::string key = InputName::displacement(name).text();
    for (const auto& [given, text] : options_.stringParameters) {
        if (given != key) continue;
        const std::optional<QueriedOutput> queried = QueriedOutput::parse(text);
        if (!queried) return false;
        const int length = queried->length;
        const Expr& to = *call.args[1];
        const Expr* root = &to;
        while (root->kind == ExprKind::Index && !root->args.empty()) root = root->args[0].get();
        const bool uniform =
            root->symbol && root->symbol->storage == Storage::Uniform && !isStringLike(to.type.base); // strings have no classes
        Inst* a = to.type.array ? array(to) : nullptr;
        const bool open = a && lengths(a);
        found = constant(0);
        if (static_cast<int>(kindOf(to.type.element())) != queried->kind || (length > 0) != (a != nullptr)) return true;
        if (uniform && queried->varying) return false; // there is no answer either, and a message why
        if (a && (a->op != Op::ArrayNew || (!open && arrayLength(a) > length))) return true;
        found = constant(1);
        if (!a) {
            assign(to, input(key, to.type, false));
            return true;
        }
        Inst* from = input(key, {to.type.base, length}, false);
        if (open) {
            const Lengths l = *lengths(a);
            Inst* n = limitLength(a, constant(static_cast<float>(length)));
            set(l.length, n);
            set(l.reserved, runtime1("al_max_f", {get(l.reserved), n}, Kind::Float));
        }
        for (int n = 0; n < std::min(length, open ? a->index : arrayLength(a)); ++n) {
            Inst* at = constant(static_cast<float>(n));
            emit(Op::ArrayStore, Kind::None, {a, at, emit(Op::ArrayLoad, from->element, {from, at})});
        }
        return true;
    }
    return false;
}

/// A primitive variable that the kernel does not have as an input. `to` may be null: whether there is one.
Inst* Builder::askPrimitive(Inst* name, const Expr* to) {
    if (shader_.kind == ShaderKind::Imager) return constant(0); // pixels are of no primitive
    Site s;
    s.op = "getvar";
    s.shadeop = findShadeop("getvar");
    s.place = keptPlace(place_);
    s.resultType = {Base::Float, 0};
    s.resultKinds = {Kind::Float};
    s.resultNames = {""};
    std::vector<Inst*> args;
    s.strings = {name->op == Op::ConstString ? name->text : ""};
    if (name->op != Op::ConstString) addArgument(s, args, name, {Base::String, 0});
    Receiver r;
    if (to) {
        r = receiver(s, *to, "value");
        if (to->symbol && to->symbol->storage == Storage::Uniform) {
            s.names.push_back(kPairUniform);
            s.pairStrings.push_back("1");
        }
    }
    const std::vector<Inst*> v = call(Op::Service, std::move(s), std::move(args));
    if (to) receive(r, std::span(v).subspan(1), emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)}));
    return v[0];
}

} // namespace alpenglow::rsl::ir

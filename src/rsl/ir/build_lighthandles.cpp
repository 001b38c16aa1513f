// Lights by their handles: getlight(), getlights(), handle->light(), handle->parameter, islightcategory(). Which lights there are
// is known to the renderer only, so each is a question to it.
#include "base/limits.h"
#include "rsl/ir/builder.h"

namespace alpenglow::rsl::ir {

namespace {

/// A question about lights; `text` is a constant, or empty where the value is an argument.
Site question(const char* op, const Place& place) {
    Site s;
    s.op = op;
    s.place = place;
    return s;
}

} // namespace

/// handle->light(L, Cl [, Ol]): L from the light to the surface, as the light's shader has it; under path with the shadow at P.
/// Further arguments are for shader objects whose light() takes more (methodCall()); other lights ignore them.
Inst* Builder::lightMethod(const Expr& e, Inst* handle) {
    if (e.text != "light" || e.args.size() < 3) { // null is null; another handle is that of a shader without methods
        Inst* some = emit(Op::NotEqual, Kind::Bool, {handle, leaves_.string("")});
        branch(
            some,
            [&] {
                complain(e.place, msg::kNoMethodOfHandle(e.text));
                return std::vector<Inst*>{zero(Kind::Float)};
            },
            [&] { return std::vector<Inst*>{zero(Kind::Float)}; });
        return zero(Kind::Float);
    }
    if (shader_.kind == ShaderKind::Light) {
        report(e.place, msg::kLightOfLight);
        return zero(Kind::Float);
    }
    const auto colour = [&](const Expr& a) { return a.type == Type{Base::Color, 0} && a.kind == ExprKind::Variable; };
    const size_t asked = e.args.size() == 4 || (e.args.size() > 4 && colour(*e.args[3])) ? 4 : 3;
    if (e.args.size() > asked && options_.coShaders.empty()) report(e.args[asked]->place, msg::kLightCall);
    const Type vector{Base::Vector, 0}, real{Base::Float, 0};
    Site s = question("lightcall", e.place);
    std::vector<Inst*> args;
    addArgument(s, args, handle, {Base::String, 0});
    addArgument(s, args, global("P", Base::Point), {Base::Point, 0});
    s.resultKinds = {Kind::Float, Kind::Triple, Kind::Triple, Kind::Triple};
    s.resultNames = {"", "L", "Cl", "Ol"};
    s.resultType = real;
    place_ = e.place;
    std::vector<Inst*> v = call(Op::Service, std::move(s), std::move(args));
    Inst* found = emit(Op::NotEqual, Kind::Bool, {v[0], constant(0)});
    if (options_.path) {
        Site shadow = question("lightvisibility", e.place);
        shadow.argKinds = {Kind::Float, Kind::Triple};
        shadow.argTypes = {real, vector};
        shadow.resultKinds = {Kind::Triple};
        shadow.resultNames = {""};
        shadow.resultType = {Base::Color, 0};
        Inst* towards = emit(Op::Sub, Kind::Triple, {zero(Kind::Triple), v[1]});
        v[2] = emit(Op::Mul, Kind::Triple, {v[2], call(Op::Request, std::move(shadow), {constant(0), towards})[0]});
    }
    for (size_t n = 1; n < asked; ++n) {
        const Expr& to = *e.args[n];
        const bool variable = to.kind == ExprKind::Variable || to.kind == ExprKind::Index;
        if (!variable || to.type.array || kindOf(to.type) != Kind::Triple) {
            report(to.place, msg::kLightArgument(n, n == 1 ? "vector" : "color"));
            return zero(Kind::Float);
        }
        const Held held(*this, to);
        assign(to, emit(Op::Select, Kind::Triple, {found, v[n], expr(to, Kind::Triple)}));
    }
    return zero(Kind::Float);
}

/// A parameter of a light. `to`: the variable that getvar() fills, which then gives whether there is one; else the value is
/// given.
Inst* Builder::lightMember(Inst* handle, Inst* name, Kind kind, const Expr* to, Inst* at) {
    Site s = question("lightparameter", place_);
    std::vector<Inst*> args;
    addArgument(s, args, handle, {Base::String, 0});
    if (name->op == Op::ConstString) s.strings = {name->text};
    else addArgument(s, args, name, {Base::String, 0});
    if (at) addArgument(s, args, at, {Base::Float, 0});
    return answered(std::move(s), std::move(args), kind, to);
}

Inst* Builder::getLight(const Expr& e) {
    Inst* name = expr(*e.args[0], Kind::String);
    Site s = question("getlight", e.place);
    std::vector<Inst*> args;
    if (name->op == Op::ConstString) s.strings = {name->text};
    else addArgument(s, args, name, {Base::String, 0});
    s.resultKinds = {Kind::String};
    s.resultNames = {""};
    s.resultType = {Base::String, 0};
    place_ = e.place;
    return call(Op::Service, std::move(s), std::move(args))[0];
}

/// The results of getlights(): the number, then the handles.
std::vector<Inst*> Builder::lightHandles(const Expr& e) {
    Site s = question("getlights", e.place);
    std::vector<Inst*> args;
    s.strings = {""};
    for (const NamedArg& p : e.pairs) {
        if (p.name != "category" || !p.value) continue;
        Inst* v = expr(*p.value, Kind::String);
        if (v->op == Op::ConstString) s.strings = {v->text};
        else addArgument(s, args, v, {Base::String, 0});
    }
    s.resultKinds.assign(static_cast<size_t>(limits::kLightHandles) + 1, Kind::String);
    s.resultNames.assign(static_cast<size_t>(limits::kLightHandles) + 1, "");
    s.resultKinds[0] = Kind::Float;
    s.resultType = {Base::String, 0};
    place_ = e.place;
    return call(Op::Service, std::move(s), std::move(args));
}

/// Whether the light of this turn of illuminance is of the category; 0 where there is no light.
Inst* Builder::isLightCategory(const Expr& e) {
    Inst* category = expr(*e.args[0], Kind::String);
    place_ = e.place;
    if (lightDepth_ == 0) {
        report(e.place, msg::kOutsideIlluminance("islightcategory"));
        return constant(0);
    }
    Site s = question("islightcategory", e.place);
    std::vector<Inst*> args;
    if (category->op == Op::ConstString) s.strings = {category->text};
    else addArgument(s, args, category, {Base::String, 0});
    s.resultKinds = {Kind::Float};
    s.resultNames = {""};
    s.resultType = {Base::Float, 0};
    return call(Op::Service, std::move(s), std::move(args))[0];
}

} // namespace alpenglow::rsl::ir

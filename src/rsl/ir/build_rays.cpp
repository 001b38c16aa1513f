// The map "raytrace" of environment() and shadow() (3Delight manual, 6.4.6): rays, not a lookup, by the requests of trace()
// and transmission(), with their optional parameters.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <set>

namespace alpenglow::rsl::ir {

namespace {
constexpr const char* kRays = "raytrace";
constexpr float kFar = 1e10f; // distance of the source of a solar light's parallel rays
} // namespace

/// A request `name` for a colour, with those of the call's pairs that it knows.
Inst* Builder::rays(const Expr& e, const char* name, const std::vector<std::pair<Inst*, Type>>& positional, Inst* cone) {
    const Shadeop& op = *findShadeop(name);
    Site s;
    s.op = name;
    s.shadeop = &op;
    s.resultType = {Base::Color, 0};
    s.pure = false;
    s.resultKinds = {Kind::Triple};
    s.resultNames = {""};
    std::vector<Inst*> args;
    for (const auto& [v, type] : positional) addArgument(s, args, v, type);
    const auto give = [&](const std::string& parameter, Inst* v, Type t) {
        if (v->op == Op::ConstString && v->text.empty()) return;
        s.names.push_back(parameter);
        s.pairStrings.push_back(v->op == Op::ConstString ? v->text : "");
        if (v->op != Op::ConstString) addArgument(s, args, v, t);
    };
    bool samples = false, coned = false;
    std::vector<const Expr*> outputs;
    for (const NamedArg& p : e.pairs) {
        const OptionalParameter* known = nullptr;
        for (const OptionalParameter& o : op.optional)
            if (o.name == p.name && o.output == p.output) known = &o;
        if (!p.value || !known) continue; // filters of maps
        if (p.value->type.array) {
            if (p.output || !known->type.array || (known->type.base == Base::String) != isStringLike(p.value->type.base))
                continue;
            Inst* from = array(*p.value);
            for (int n = 0; n < arrayLength(from); ++n)
                give(p.name + "[" + std::to_string(n) + "]",
                     emit(Op::ArrayLoad, from->element, {from, constant(static_cast<float>(n))}), p.value->type.element());
            continue;
        }
        if (p.output) {
            s.resultKinds.push_back(kindOf(p.value->type));
            s.resultNames.push_back(p.name);
            outputs.push_back(p.value.get());
            continue;
        }
        Inst* v = expr(*p.value);
        if ((known->type.base == Base::String) != (v->kind == Kind::String)) continue;
        samples |= p.name == "samples";
        coned |= p.name == "samplecone";
        give(p.name, coerce(v, known->type.element()), known->type.element());
    }
    const Type real{Base::Float, 0};
    if (cone && !coned) give("samplecone", cone, real);
    if ((cone || coned) && !samples) give("samples", constant(4), real); // what a map takes
    for (const auto& [output, parameter] : messageSlots_)
        if (op.name == "trace") give(PairName::surface(output).text(), get(parameter.first), parameter.second);
    place_ = e.place;
    const std::vector<Inst*> r = call(Op::Request, std::move(s), std::move(args));
    for (size_t n = 0; n < outputs.size(); ++n) {
        const Held held(*this, *outputs[n]);
        assign(*outputs[n], r[n + 1]);
    }
    return r[0];
}

/// Parameters of environment() that files have no use for.
bool Builder::ofRaysOnly(const Expr& e, const std::string& parameter) {
    if (e.shadeop->name != "environment") return false;
    const auto known = [&](const char* op) {
        const std::vector<OptionalParameter>& list = findShadeop(op)->optional;
        return std::any_of(list.begin(), list.end(), [&](const OptionalParameter& o) { return o.name == parameter; });
    };
    return known("trace") && !known("texture");
}

/// environment() and shadow() where the map is rays; null where it is a file.
Inst* Builder::tracedMap(const Expr& e) {
    const bool shadow = e.shadeop->name == "shadow";
    if (e.args.empty() || (!shadow && e.shadeop->name != "environment")) return nullptr;
    if (shader_.kind != ShaderKind::Surface && shader_.kind != ShaderKind::Volume && shader_.kind != ShaderKind::Light)
        return nullptr;
    Inst* name = expr(*e.args[0], Kind::String);
    if (name->op != Op::ConstString || name->text != kRays) return nullptr;
    std::vector<Inst*> at;
    for (size_t i = 1; i < e.args.size(); ++i) at.push_back(expr(*e.args[i], Kind::Triple));
    if (at.empty()) return nullptr;
    place_ = e.place;
    const auto times = [&](Inst* v, float k) { return emit(Op::Mul, Kind::Triple, {v, coerce(constant(k), Kind::Triple)}); };
    const auto plus = [&](Inst* a, Inst* b) { return emit(Op::Add, Kind::Triple, {a, b}); };
    const auto unit = [&](Inst* v) { return runtime1("al_normalize_t", {v}, Kind::Triple); };
    Inst* middle = at[0];
    if (at.size() == 4) middle = times(plus(plus(at[0], at[1]), plus(at[2], at[3])), 0.25f);
    const bool light = shader_.kind == ShaderKind::Light;
    const Type point{Base::Point, 0}, vector{Base::Vector, 0};
    Inst* seen = nullptr;
    if (shadow) {
        Inst* toLight = nullptr;
        const auto l = globals_.find("L");
        if (light) {
            Inst* from = blockDepth_ > 0 && l != globals_.end()
                             ? get(l->second)
                             : emit(Op::Sub, Kind::Triple, {global("Ps", Base::Point), global("P", Base::Point)});
            toLight = inSolar_ ? times(unit(from), -kFar) : emit(Op::Neg, Kind::Triple, {from});
        } else if (lightDepth_ > 0 && l != globals_.end()) {
            toLight = get(l->second);
        } else {
            report(e.place, msg::kShadowOutside);
            return zero(kindOf(e.type));
        }
        seen = rays(e, "transmission", {{middle, point}, {plus(middle, toLight), point}}, nullptr);
        seen = emit(Op::Sub, Kind::Triple, {leaves_.constant(Kind::Triple, 1.0f), seen});
    } else {
        Inst* cone = nullptr;
        const auto larger = [&](Inst* v) { cone = cone ? runtime1("al_max_f", {cone, v}, Kind::Float) : v; };
        Inst* axis = unit(middle);
        if (at.size() == 4) // as wide as the corners are apart
            for (Inst* corner : at)
                larger(runtime1("al_acos", {runtime1("al_min_f", {constant(1), dot(axis, unit(corner))}, Kind::Float)},
                                Kind::Float));
        for (const NamedArg& p : e.pairs) // a part of the map: all of it is every direction
            if (p.value && p.name == "blur" && p.value->type == Type{Base::Float, 0}) {
                Inst* b = emit(Op::Mul, Kind::Float, {expr(*p.value, Kind::Float), constant(3.14159274f)});
                cone = cone ? emit(Op::Add, Kind::Float, {cone, b}) : b;
            }
        seen = rays(e, "trace", {{global(light ? "Ps" : "P", Base::Point), point}, {axis, vector}}, cone);
    }
    if (kindOf(e.type) != Kind::Float) return seen;
    const auto part = [&](int n) { return emit(Op::Extract, Kind::Float, {seen}, n); };
    if (shadow)
        return emit(Op::Mul, Kind::Float,
                    {emit(Op::Add, Kind::Float, {emit(Op::Add, Kind::Float, {part(0), part(1)}), part(2)}), constant(1 / 3.0f)});
    Inst* channel = e.channel ? expr(*e.channel, Kind::Float) : constant(0);
    const auto from = [&](float n) { return emit(Op::Less, Kind::Bool, {channel, constant(n)}); };
    return emit(Op::Select, Kind::Float, {from(1), part(0), emit(Op::Select, Kind::Float, {from(2), part(1), part(2)})});
}

} // namespace alpenglow::rsl::ir

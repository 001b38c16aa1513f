// occlusion() and indirectdiffuse() (3Delight manual, 6.4.5.3). The first asks how much of a hemisphere is open, a number, so
// that shaders stay affine in it; the second is trace() with the cosine distribution.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>
#include <set>
#include <string_view>

namespace alpenglow::rsl::ir {

namespace {

const OptionalParameter* parameterNamed(const Shadeop& op, const std::string& name) {
    for (const OptionalParameter& o : op.optional)
        if (o.name == name) return &o;
    return nullptr;
}

/// What trace() calls a parameter of indirectdiffuse(); "" where it has none.
std::string nameInTrace(const std::string& name) {
    if (name == "coneangle") return "samplecone";
    if (name == "axis") return "horizon";
    static const std::set<std::string_view> kSame = {
        "label",         "subset",         "bias",    "hitmode",     "hitsides",     "maxdist",          "samplebase",   "type",
        "excludesubset", "raytype",        "samples", "raylabel",    "maxhitdist",   "environmentspace", "distribution", "weight",
        "samplecone",    "environmentmap", "falloff", "falloffmode", "maxvariation", "maxpixeldist"};
    return kSame.count(name) ? name : "";
}

/// What an output is called among the results of a request; "" where it is none of theirs.
std::string resultNamed(const std::string& output, bool occlusion) {
    if (output == "environmentcolor") return "environmentcontribution";
    if (output == "environmentdir") return "environmentdir";
    return output == "occlusion" && !occlusion ? "transmission" : "";
}

} // namespace

/// A call of occlusion() or indirectdiffuse() as a request: its arguments and the variables of its results.
struct Builder::Hemisphere {
    Site site;
    std::vector<Inst*> args;
    std::vector<std::pair<const Expr*, std::string>> outputs; ///< a variable, and the result that it takes; "": the occlusion
    std::set<std::string> given;
};

void Builder::hemispherePairs(const Expr& e, Inst* normal, bool occlusion, Hemisphere& h) {
    const auto give = [&](const std::string& name, Inst* v, Type t) {
        if (v->op == Op::ConstString && v->text.empty()) return;
        if (!h.given.insert(name).second) return;
        h.site.names.push_back(name);
        h.site.pairStrings.push_back(v->op == Op::ConstString ? v->text : "");
        if (v->op != Op::ConstString) addArgument(h.site, h.args, v, t);
    };
    const Type real{Base::Float, 0};
    for (const NamedArg& p : e.pairs) {
        const OptionalParameter* known = p.value ? parameterNamed(*e.shadeop, p.name) : nullptr;
        if (!known || p.value->type.array) continue;
        if (p.output) {
            if (const std::string r = resultNamed(p.name, occlusion); !r.empty() || p.name == "occlusion")
                h.outputs.push_back({p.value.get(), r});
            continue;
        }
        Inst* v = expr(*p.value);
        if ((known->type.base == Base::String) != (v->kind == Kind::String) || v->kind == Kind::Matrix) continue;
        v = coerce(v, known->type.element());
        static const std::set<std::string_view> kOfPoints = {"pointbased", "filename",     "filenames",  "maxsolidangle",
                                                             "clamp",      "sortbleeding", "coordsystem"};
        if (kOfPoints.count(p.name)) continue; // rays know nothing of them
        if (p.name == "samples" && h.given.count("samples")) continue;
        if (p.name == "axis") { // none: every direction
            if (isConst(v, 0)) continue;
            v = emit(Op::Select, Kind::Triple, {emit(Op::Equal, Kind::Bool, {dot(v, v), constant(0)}), normal, v});
        }
        const std::string name = !occlusion ? nameInTrace(p.name) : p.name == "samplecone" ? "coneangle" : p.name;
        if (!name.empty()) give(name, v, known->type.element());
    }
    if (occlusion) return;
    give("distribution", leaves_.string("cosine"), {Base::String, 0});
    if (!h.given.count("raytype")) give("type", leaves_.string("diffuse"), {Base::String, 0});
    give("samplecone", constant(1.57079633f), real);
    give(kPairHemisphere, leaves_.string("1"), {Base::String, 0});
    for (const auto& [output, parameter] : messageSlots_)
        give(PairName::surface(output).text(), get(parameter.first), parameter.second);
}

/// Whether a call is to be answered from point clouds: an instruction with the answer, or null where it names none. PRMan 12 and
/// Aqsis knew no "pointbased": there a file and no samples mean it.
Inst* Builder::readsPoints(const Expr& e) {
    const bool below = e.shadeop->name == "subsurface";
    bool named = false;
    Inst* wanted = nullptr;
    const Expr* file = nullptr;
    const auto isCloud = [&](Inst* type) {
        if (type->op == Op::ConstString) return boolean(type->text == "pointcloud");
        return emit(Op::Equal, Kind::Bool, {type, leaves_.string("pointcloud")});
    };
    if (below && !e.args.empty() && e.args[0]->type.base == Base::String) wanted = isCloud(expr(*e.args[0], Kind::String));
    for (const NamedArg& p : e.pairs) {
        if (!p.value || p.output) continue;
        named |= p.name == "filename" || p.name == "filenames";
        if (!below && p.name == "filename") file = p.value.get();
        if (below && p.name == "type") wanted = isCloud(expr(*p.value, Kind::String));
        if (below || p.name != "pointbased") continue;
        Inst* v = expr(*p.value, Kind::Float);
        wanted = v->op == Op::Const ? boolean(v->numbers[0] != 0) : emit(Op::NotEqual, Kind::Bool, {v, constant(0)});
    }
    const bool bySamples = !wanted && file && e.args.size() > 2 && e.signature->parameters[2].type.base == Base::Float;
    if (bySamples) {
        Inst *name = expr(*file, Kind::String), *samples = expr(*e.args[2], Kind::Float);
        Inst* none =
            samples->op == Op::Const ? boolean(samples->numbers[0] == 0) : emit(Op::Equal, Kind::Bool, {samples, constant(0)});
        Inst* given = name->op == Op::ConstString ? boolean(!name->text.empty())
                                                  : emit(Op::NotEqual, Kind::Bool, {name, leaves_.string("")});
        if (none->op == Op::Const && given->op == Op::Const) wanted = boolean(none->numbers[0] != 0 && given->numbers[0] != 0);
        else wanted = emit(Op::And, Kind::Bool, {none, given});
    }
    return !wanted || (below && !named) || (wanted->op == Op::Const && wanted->numbers[0] == 0) ? nullptr : wanted;
}

/// Null where the call is no hemisphere, or has a form that is no request.
Inst* Builder::hemisphere(const Expr& e) {
    const std::string& op = e.shadeop->name;
    if ((op != "occlusion" && op != "indirectdiffuse" && op != "subsurface") || !e.signature) return nullptr;
    if (op == "indirectdiffuse" && e.args.size() == 2 && e.signature->parameters[0].type.base == Base::String)
        return service(e, Op::Service); // from a map, at once
    Inst* const points = readsPoints(e);
    const auto traced = [&] { return op == "subsurface" ? service(e, Op::Request) : tracedHemisphere(e); };
    if (!points) return op == "subsurface" ? nullptr : traced();
    const auto read = [&] { return service(e, Op::Service, -1, true); };
    if (points->op == Op::Const) return read();
    const Kind k = kindOf(e.type);
    return branch(
        points, [&] { return std::vector<Inst*>{coerce(read(), k)}; },
        [&] { return std::vector<Inst*>{coerce(traced(), k)}; })[0];
}

Inst* Builder::tracedHemisphere(const Expr& e) {
    const bool occlusion = e.shadeop->name == "occlusion";
    const Type real{Base::Float, 0}, point{Base::Point, 0}, vector{Base::Vector, 0};
    size_t at = 0;
    if (e.signature->parameters[0].type.base == Base::String) {
        if (const Inst* map = expr(*e.args[0], Kind::String);
            map->op != Op::ConstString || !(map->text.empty() || map->text == "raytrace"))
            report(e.args[0]->place, msg::kFileNotRead(e.shadeop->name));
        at = 1;
    }
    Hemisphere h;
    Inst* from = expr(*e.args[at], Kind::Triple);
    Inst* normal = expr(*e.args[at + 1], Kind::Triple);
    addArgument(h.site, h.args, from, point);
    addArgument(h.site, h.args, normal, vector);
    const bool air = e.args.size() == 4 && at == 0; // a half angle, and the mean free direction
    if (e.args.size() > at + 2) {
        const char* name = air ? "coneangle" : "samples";
        Inst* v = expr(*e.args[at + 2], Kind::Float);
        h.given.insert(name);
        h.site.names.push_back(name);
        h.site.pairStrings.push_back("");
        addArgument(h.site, h.args, v, real);
    }
    if (air) h.outputs.push_back({e.args[3].get(), "environmentdir"});
    place_ = e.place;
    hemispherePairs(e, normal, occlusion, h);
    Site& s = h.site;
    s.op = occlusion ? "occlusion" : "trace";
    s.shadeop = findShadeop(s.op);
    s.resultType = occlusion ? real : Type{Base::Color, 0};
    s.resultKinds = {kindOf(s.resultType)};
    s.resultNames = {""};
    std::vector<size_t> which;
    for (const auto& [variable, result] : h.outputs) {
        const auto known =
            result.empty() ? s.resultNames.begin() : std::find(s.resultNames.begin() + 1, s.resultNames.end(), result);
        which.push_back(static_cast<size_t>(known - s.resultNames.begin()));
        if (known != s.resultNames.end()) continue;
        s.resultNames.push_back(result);
        s.resultKinds.push_back(Kind::Triple);
    }
    place_ = e.place;
    const std::vector<Inst*> r = call(Op::Request, std::move(s), std::move(h.args));
    const auto blocked = [&](Inst* open) { return emit(Op::Sub, Kind::Float, {constant(1), open}); };
    Inst* const value = occlusion ? blocked(r[0]) : r[0];
    for (size_t n = 0; n < h.outputs.size(); ++n) {
        const auto& [variable, result] = h.outputs[n];
        Inst* v = r[which[n]];
        if (result.empty()) v = value;
        else if (result == "transmission")
            v = blocked(emit(Op::Mul, Kind::Float, {dot(v, leaves_.constant(Kind::Triple, 1.0f)), constant(1 / 3.0f)}));
        else if (result == "environmentdir") v = runtime1("al_normalize_t", {v}, Kind::Triple);
        const Held held(*this, *variable);
        assign(*variable, coerce(v, kindOf(variable->type)));
    }
    return coerce(value, kindOf(e.type));
}

} // namespace alpenglow::rsl::ir

// occlusion() and indirectdiffuse() (rsl.md 12.2). The first asks the renderer how much of a hemisphere is open, a number, so
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
    static const std::set<std::string_view> kSame = {"label",   "subset",     "bias",          "hitmode",          "hitsides",
                                                     "maxdist", "samplebase", "type",          "excludesubset",    "raytype",
                                                     "samples", "raylabel",   "maxhitdist",    "environmentspace", "distribution",
                                                     "weight",  "samplecone", "environmentmap",
                                                     "falloff", "falloffmode", "maxvariation", "maxpixeldist"};
    return kSame.count(name) ? name : "";
}

/// What an output is called among the results of a request; "" where it is none of theirs.
std::string resultNamed(const std::string& output, bool occlusion) {
    if (output == "environmentcolor") return "environmentcontribution";
    if (output == "environmentdir") return "environmentdir";
    return output == "occlusion" && !occlusion ? "transmission" : "";
}

} // namespace

/// A call of occlusion() or indirectdiffuse() as a request: what it asks, and where its results go.
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
        if (p.name == "pointbased" && !isConst(v, 0))
            warn(p.place,
                 e.shadeop->name + "(): point clouds are not yet read; rays are traced, which gives what they stand for");
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
    for (const auto& [output, parameter] : messageSlots_) give(PairName::surface(output).text(), get(parameter.first), parameter.second);
}

/// Null where the call is another, or has a form that is no request.
Inst* Builder::hemisphere(const Expr& e) {
    const bool occlusion = e.shadeop->name == "occlusion";
    if ((!occlusion && e.shadeop->name != "indirectdiffuse") || !e.signature) return nullptr;
    const Type real{Base::Float, 0}, point{Base::Point, 0}, vector{Base::Vector, 0};
    size_t at = 0;
    if (e.signature->parameters[0].type.base == Base::String) {
        if (e.args.size() == 2) return service(e, Op::Service); // from a map, at once
        if (const Inst* map = expr(*e.args[0], Kind::String);
            map->op != Op::ConstString || !(map->text.empty() || map->text == "raytrace"))
            warn(e.args[0]->place, e.shadeop->name + "(): no file is read; rays are traced, which gives what it stands for");
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

// bsdf(): the distribution is chosen by its name, when the shader is compiled if that is known then. The distributions themselves
// are runtime code (shadeops/bsdf/).
#include "rsl/ir/builder.h"
#include "shadeops/distributions.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

namespace {

constexpr int kHairLobes = 4, kHairParameters = 4; // 3Delight manual, 6.4.5.2

} // namespace

/// The values of the parameters of one call.
struct Builder::Distribution {
    Inst *l, *n;
    std::map<std::string, Inst*> values;
    std::vector<Inst*> eta, lobes;
};

/// The parts of one distribution: one colour, two of glass (reflected, refracted), one a lobe of hair.
std::vector<Inst*> Builder::distribution(const std::string& name, const Distribution& d) {
    const auto value = [&](const char* what, Inst* otherwise) {
        const auto found = d.values.find(what);
        return found == d.values.end() ? otherwise : coerce(found->second, otherwise->kind);
    };
    const auto triple = [&](Inst* v) { return coerce(v, Kind::Triple); };
    if (name == "uniform" || name == "cosine")
        return {triple(runtime1("al_bsdf_" + name, {d.l, d.n, value("samplecone", constant(1.57079637f))}, Kind::Float))};
    const auto given = d.values.find("wo");
    Inst* wo = given != d.values.end() ? triple(given->second) : emit(Op::Neg, Kind::Triple, {global("I", Base::Vector)});
    Inst* roughness = value("roughness", constant(0));
    Inst* roughnessv = value("roughnessv", roughness);
    Inst* udir = value("udir", zero(Kind::Triple));
    const auto index = [&](size_t i, float otherwise) {
        return i < d.eta.size() ? triple(d.eta[i]) : triple(constant(otherwise));
    };
    if (name == "oren-nayar") return {triple(runtime1("al_bsdf_orennayar", {d.l, d.n, wo, roughness}, Kind::Float))};
    if (name == "blinn") return {runtime1("al_bsdf_blinn", {d.l, d.n, wo, roughness, index(0, 0), index(1, 0)}, Kind::Triple)};
    if (name == "cook-torrance")
        return {runtime1("al_bsdf_cooktorrance", {d.l, d.n, wo, roughness, index(0, 0), index(1, 0)}, Kind::Triple)};
    if (name == "ashikhmin-shirley")
        return {runtime1("al_bsdf_ashikhminshirley", {d.l, d.n, wo, udir, roughness, roughnessv, index(0, 0), index(1, 0)},
                         Kind::Triple)};
    if (name == "ggx" || name == "beckmann")
        return {runtime1("al_bsdf_" + name, {d.l, d.n, wo, udir, roughness, roughnessv, index(0, 0), index(1, 0)}, Kind::Triple)};
    if (name == "ward") return {triple(runtime1("al_bsdf_ward", {d.l, d.n, wo, udir, roughness, roughnessv}, Kind::Float))};
    const auto first = [&](Inst* v) { return emit(Op::Extract, Kind::Float, {v}, 0); };
    if (name == "glass-ggx") {
        std::vector<Inst*> parts = runtime(
            "al_bsdf_glassggx", {d.l, d.n, wo, udir, roughness, roughnessv, first(index(0, 1.5f)), constant(0), constant(0)},
            {Kind::Float, Kind::Float});
        for (size_t i = 0; i < 2; ++i) {
            if (i < d.lobes.size()) parts[i] = emit(Op::Mul, Kind::Float, {parts[i], d.lobes[i]});
            parts[i] = triple(parts[i]);
        }
        return parts;
    }
    // Hair. Weights above 1 are scaled down together.
    std::vector<Inst*> lobes = d.lobes;
    if (lobes.empty())
        for (int lobe = 0; lobe < 3; ++lobe)
            lobes.insert(lobes.end(), {constant(1), constant(0), constant(0.3f), constant(0.3f)});
    const size_t count = std::min<size_t>(kHairLobes, lobes.size() / kHairParameters);
    Inst* largest = constant(1);
    for (size_t i = 0; i < count; ++i) largest = runtime1("al_max_f", {largest, lobes[i * kHairParameters]}, Kind::Float);
    std::vector<Inst*> parts;
    for (size_t i = 0; i < count; ++i) {
        const auto number = [&](size_t k) { return lobes[i * kHairParameters + k]; };
        Inst* v = runtime1("al_bsdf_hair",
                           {d.l, d.n, wo, udir, first(index(0, 1.55f)), value("absorption", zero(Kind::Triple)),
                            constant(static_cast<float>(i)), number(1), number(2), number(3)},
                           Kind::Triple);
        parts.push_back(emit(Op::Mul, Kind::Triple, {v, triple(emit(Op::Div, Kind::Float, {number(0), largest}))}));
    }
    if (parts.empty()) parts.push_back(zero(Kind::Triple));
    return parts;
}

/// A name that is known when the shader runs is none: said then, and 0.
Inst* Builder::noSuchDistribution(Inst* name, const Expr& e) {
    Site s;
    s.op = "complaint";
    const std::string text = noDistribution(e.shadeop->name, "");
    s.strings = {text.substr(0, text.size() - 1), "", "\"; its value is 0; " + knownDistributions()};
    std::vector<Inst*> args;
    addArgument(s, args, name, {Base::String, 0});
    place_ = e.place;
    call(Op::Service, std::move(s), std::move(args));
    return zero(Kind::Triple);
}

/// Of a call that sends rays: an error where it names a distribution that there is not.
void Builder::checkDistribution(const Expr& e) {
    const bool hemisphere = e.shadeop->name == "occlusion" || e.shadeop->name == "indirectdiffuse";
    for (const NamedArg& p : e.pairs) {
        if (!p.value || p.output || (p.name != "distribution" && p.name != "bsdf") || p.value->type.base != Base::String)
            continue;
        const Inst* name = expr(*p.value, Kind::String);
        if (name->op != Op::ConstString || name->text.empty()) continue;
        if (hemisphere ? name->text == "uniform" || name->text == "cosine" : isDistribution(name->text, true)) continue;
        error(p.place, noDistribution(e.shadeop->name, name->text) + "; " +
                           (hemisphere ? std::string("it is uniform or cosine") : knownDistributions()));
    }
}

/// The value of a call of bsdf() that gives one colour, or the parts of one that gives an array.
std::vector<Inst*> Builder::bsdf(const Expr& written) {
    const Expr& e = withNames(written);
    Distribution d;
    d.l = expr(*e.args[0], Kind::Triple);
    d.n = expr(*e.args[1], Kind::Triple);
    Inst* name = nullptr;
    const auto elements = [&](const Expr& x) {
        if (!x.type.array) return std::vector<Inst*>{expr(x)};
        std::vector<Inst*> list;
        Inst* a = array(x);
        for (int i = 0; i < arrayLength(a); ++i)
            list.push_back(emit(Op::ArrayLoad, a->element, {a, constant(static_cast<float>(i))}));
        return list;
    };
    for (const NamedArg& p : e.pairs) {
        if (!p.value) continue;
        if (p.name == "distribution" || p.name == "bsdf") name = expr(*p.value, Kind::String);
        else if (p.name == "eta") d.eta = elements(*p.value);
        else if (p.name == "lobeparameters") d.lobes = elements(*p.value);
        else d.values[p.name] = expr(*p.value);
    }
    for (Inst*& v : d.lobes) v = coerce(v, Kind::Float);
    place_ = e.place;
    const bool parted = e.type.array != 0;
    const auto sum = [&](const std::vector<Inst*>& parts) {
        Inst* all = parts[0];
        for (size_t i = 1; i < parts.size(); ++i) all = emit(Op::Add, Kind::Triple, {all, parts[i]});
        return all;
    };
    std::vector<Inst*> result;
    const std::string known = !name ? "uniform" : name->op == Op::ConstString ? name->text : "";
    if (name && name->op != Op::ConstString) { // one branch a name
        if (parted)
            warn(e.place,
                 "bsdf() with parts needs a distribution that is known when the shader is compiled; all is in the first");
        const std::function<Inst*(size_t)> from = [&](size_t i) -> Inst* {
            if (i == std::size(kDistributions)) return noSuchDistribution(name, e);
            Inst* is = emit(Op::Equal, Kind::Bool, {name, leaves_.string(kDistributions[i])});
            return branch(
                is, [&] { return std::vector<Inst*>{sum(distribution(kDistributions[i], d))}; },
                [&] { return std::vector<Inst*>{from(i + 1)}; })[0];
        };
        result = {from(0)};
    } else if (!isDistribution(known, false)) {
        error(e.place, noDistribution("bsdf", known) + "; " + knownDistributions());
        result = {zero(Kind::Triple)};
    } else {
        result = distribution(known, d);
        if (!parted) result = {sum(result)};
        else if (known != "glass-ggx" && known != "hair")
            warn(e.place, "bsdf(): \"" + known + "\" has no parts; all is in the first");
    }
    // The plane of "horizon" lets through what lies on the same side of it as of the surface; a fibre has no surface.
    if (const auto h = d.values.find("horizon"); h != d.values.end() && known != "hair") {
        Inst* plane = coerce(h->second, Kind::Triple);
        Inst* side = emit(Op::Mul, Kind::Float, {dot(plane, d.l), dot(d.n, d.l)});
        Inst* open = emit(
            Op::Or, Kind::Bool,
            {emit(Op::Less, Kind::Bool, {constant(0), side}), emit(Op::Equal, Kind::Bool, {dot(plane, plane), constant(0)})});
        for (Inst*& v : result) v = emit(Op::Select, Kind::Triple, {open, v, zero(Kind::Triple)});
    }
    return result;
}

} // namespace alpenglow::rsl::ir

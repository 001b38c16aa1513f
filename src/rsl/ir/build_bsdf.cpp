// bsdf(): chooses the distribution by its name: when the shader is compiled if the name is known then, else by a branch a name.
// The formulas are runtime code (shadeops/bsdf/).
#include "rsl/ir/builder.h"
#include <algorithm>
#include <utility>

namespace alpenglow::rsl::ir {

/// The values of the parameters of one call.
struct Builder::DistributionCall {
    Inst *l, *n;
    std::map<std::string, Inst*> values;
    std::vector<Inst*> eta, lobes;
};

/// The argument of a distribution's formula that has this name; `numbers`: the lobe's index, then its numbers but the weight.
Inst* Builder::distributionArgument(const Distribution& m, const DistributionCall& d, const Parameter& p,
                                    const std::vector<Inst*>& numbers, size_t& next) {
    const auto value = [&](const std::string& what, Inst* otherwise) {
        const auto found = d.values.find(what);
        return found == d.values.end() ? otherwise : coerce(found->second, otherwise->kind);
    };
    const auto index = [&](size_t i, float otherwise) {
        Inst* v = coerce(i < d.eta.size() ? d.eta[i] : constant(otherwise), Kind::Triple);
        return p.type.base == Base::Float ? emit(Op::Extract, Kind::Float, {v}, 0) : v;
    };
    if (p.output) return constant(0);
    if (p.name == "l") return d.l;
    if (p.name == "n" || p.name == "tip") return d.n;
    if (p.name == "wo") {
        const auto given = d.values.find("wo");
        return given != d.values.end() ? coerce(given->second, Kind::Triple)
                                       : emit(Op::Neg, Kind::Triple, {global("I", Base::Vector)});
    }
    if (p.name == "cone") return value("samplecone", constant(1.57079637f));
    if (p.name == "roughnessv") return value(p.name, value("roughness", constant(0)));
    if (p.name == "eta") return index(0, m.eta);
    if (p.name == "k") return index(1, 0);
    if (!m.lobe.empty() && (p.name == "lobe" || next > 0) && next < numbers.size()) return numbers[next++];
    return value(p.name, p.type.base == Base::Float ? constant(0) : zero(Kind::Triple)); // roughness, udir, absorption
}

/// The parts of one distribution, each a color: its result or its outputs, for each lobe if it has lobes.
std::vector<Inst*> Builder::distribution(const Distribution& m, const DistributionCall& d) {
    const Signature& s = m.formula.signatures[0];
    const auto call = [&](const std::vector<Inst*>& numbers) {
        std::vector<Inst*> args;
        std::vector<Kind> results;
        size_t next = 0;
        if (s.result.base != Base::Void) results.push_back(kindOf(s.result));
        for (const Parameter& p : s.parameters) {
            args.push_back(distributionArgument(m, d, p, numbers, next));
            if (p.output) results.push_back(kindOf(p.type));
        }
        return runtime(s.symbol, std::move(args), std::move(results));
    };
    if (m.lobe.empty()) {
        std::vector<Inst*> parts = call({});
        for (size_t i = 0; i < parts.size(); ++i) {
            if (m.parts > 1 && i < d.lobes.size()) parts[i] = emit(Op::Mul, Kind::Float, {parts[i], d.lobes[i]});
            parts[i] = coerce(parts[i], Kind::Triple);
        }
        return parts;
    }
    std::vector<Inst*> lobes = d.lobes; // Weights above 1 are scaled down together.
    for (int i = 0; d.lobes.empty() && i < m.lobes; ++i)
        for (float number : m.lobe) lobes.push_back(constant(number));
    const size_t count = std::min(static_cast<size_t>(m.parts), lobes.size() / m.lobe.size());
    Inst* largest = constant(1);
    for (size_t i = 0; i < count; ++i) largest = runtime1("al_max_f", {largest, lobes[i * m.lobe.size()]}, Kind::Float);
    std::vector<Inst*> parts;
    for (size_t i = 0; i < count; ++i) {
        std::vector<Inst*> numbers(lobes.begin() + std::ptrdiff_t(i * m.lobe.size()),
                                   lobes.begin() + std::ptrdiff_t((i + 1) * m.lobe.size()));
        Inst* weight = std::exchange(numbers[0], constant(static_cast<float>(i)));
        Inst* v = coerce(call(numbers)[0], Kind::Triple);
        parts.push_back(emit(Op::Mul, Kind::Triple, {v, coerce(emit(Op::Div, Kind::Float, {weight, largest}), Kind::Triple)}));
    }
    if (parts.empty()) parts.push_back(zero(Kind::Triple));
    return parts;
}

/// Reports, when the shader runs, that the name is no distribution; the value is 0.
Inst* Builder::noSuchDistribution(Inst* name, const Expr& e) {
    Site s = complaint(msg::kNoSuchDistributionHere(e.shadeop->name, kWhenRun, knownDistributions()));
    std::vector<Inst*> args;
    addArgument(s, args, name, {Base::String, 0});
    place_ = e.place;
    call(Op::Service, std::move(s), std::move(args));
    return zero(Kind::Triple);
}

/// Reports an error if a call that sends rays names an unknown distribution.
void Builder::checkDistribution(const Expr& e) {
    const bool hemisphere = e.shadeop->name == "occlusion" || e.shadeop->name == "indirectdiffuse";
    for (const NamedArg& p : e.pairs) {
        if (!p.value || p.output || (p.name != "distribution" && p.name != "bsdf") || p.value->type.base != Base::String)
            continue;
        const Inst* name = expr(*p.value, Kind::String);
        if (name->op != Op::ConstString || name->text.empty()) continue;
        if (hemisphere ? name->text == "uniform" || name->text == "cosine" : isDistribution(name->text, true)) continue;
        report(p.place, msg::kNoSuchDistribution(e.shadeop->name, name->text,
                                                 hemisphere ? std::string("it is uniform or cosine") : knownDistributions()));
    }
}

/// The value of a call of bsdf() that gives one colour, or the parts of one that gives an array.
std::vector<Inst*> Builder::bsdf(const Expr& written) {
    const Expr& e = withNames(written);
    DistributionCall d;
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
    const bool inParts = e.type.array != 0;
    const auto sum = [&](const std::vector<Inst*>& parts) {
        Inst* all = parts[0];
        for (size_t i = 1; i < parts.size(); ++i) all = emit(Op::Add, Kind::Triple, {all, parts[i]});
        return all;
    };
    std::vector<Inst*> result;
    const std::string known = !name ? "uniform" : name->op == Op::ConstString ? name->text : "";
    const Distribution* const m = findDistribution(known);
    if (name && name->op != Op::ConstString) { // one branch a name
        if (inParts) report(e.place, msg::kBsdfPartsConstant);
        const std::function<Inst*(size_t)> from = [&](size_t i) -> Inst* {
            if (i == distributions().size()) return noSuchDistribution(name, e);
            const Distribution& one = distributions()[i];
            Inst* is = emit(Op::Equal, Kind::Bool, {name, leaves_.string(one.name)});
            return branch(
                is, [&] { return std::vector<Inst*>{sum(distribution(one, d))}; },
                [&] { return std::vector<Inst*>{from(i + 1)}; })[0];
        };
        result = {from(0)};
    } else if (!m) {
        report(e.place, msg::kNoSuchDistribution("bsdf", known, knownDistributions()));
        result = {zero(Kind::Triple)};
    } else {
        result = distribution(*m, d);
        if (!inParts) result = {sum(result)};
        else if (m->parts == 1) report(e.place, msg::kBsdfParts(known));
    }
    // The plane of "horizon" lets through what lies on the same side of it as of the surface; a fibre has no surface.
    if (const auto h = d.values.find("horizon"); h != d.values.end() && (!m || m->surface)) {
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

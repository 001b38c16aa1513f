// The outputs of a kernel: those that its user requests by name (protocol.h), or those of its kind of shader.
#include "rsl/front/protocol.h"
#include "rsl/ir/builder.h"
#include <algorithm>

namespace alpenglow::rsl::ir {

void Builder::putOut(const std::string& name, Inst* value, Type type) {
    const auto one = [&](const std::string& slot, Inst* v, Type t) {
        k_.outputs.push_back({slot, v->kind, storedType(t)});
        emit(Op::Output, Kind::None, {v}, static_cast<int>(k_.outputs.size()) - 1);
    };
    if (value->kind != Kind::Array) return one(name, value, type);
    refuseLonger(value, shader_.place, "the output '" + name + "'");
    const int n = lengths(value) ? value->index : given_.count(value) ? given_.at(value) : arrayLength(value);
    for (int e = 0; e < n; ++e) one(name + "[" + std::to_string(e) + "]", load(value, e), type.element());
}

/// Zero on every way through conditions (a block puts Cl back to what it was, so both sides of an if may give zero).
static bool isZero(const Inst* v) {
    if (isConst(v)) return std::all_of(v->numbers.begin(), v->numbers.end(), [](float f) { return f == 0; });
    if (v->op != Op::Result || v->args[0]->op != Op::If) return false;
    const Inst* branch = v->args[0];
    return std::all_of(branch->regions.begin(), branch->regions.end(),
                       [&](const Region& r) { return isZero(r.yields[static_cast<size_t>(v->index)]); });
}

/// What the renderer must know of a light: its blocks, and whether it lights outside of them.
void Builder::noteBlocks() {
    k_.facts.ambientLight = lightBlocks_.empty();
    for (const LightBlock& b : lightBlocks_)
        k_.facts.blocks.push_back(!b.solar                ? "illuminate"
                                  : b.stmt->exprs.empty() ? kBlockSky
                                  : b.cone                ? kBlockCone
                                                          : kBlockSolar);
    // Where no block has run, Cl is ambient light.
    const auto cl = globals_.find("Cl");
    const Inst* ran = get(blockRan_);
    const bool always = isConst(ran) && ran->numbers[0] != 0;
    if (!lightBlocks_.empty() && !always && cl != globals_.end() && !isZero(get(cl->second)))
        k_.facts.blocks.push_back(kBlockOutside);
}

/// The default outputs of this kind of shader.
std::vector<std::string> Builder::usualOutputs() const {
    switch (shader_.kind) {
    case ShaderKind::Displacement:
        return {"P", "N"};
    case ShaderKind::Transformation:
        return {"P"};
    case ShaderKind::Imager:
        return {"Ci", "Oi", "alpha"};
    case ShaderKind::Light:
        break;
    default:
        return {"Ci", "Oi"};
    }
    if (lightBlocks_.empty()) return {"Cl", "Ol"};
    std::vector<std::string> all;
    for (size_t b = 0; b < lightBlocks_.size(); ++b)
        for (const char* n : {"L", "Cl", "Ol", "lit"}) all.push_back(OutputName::ofBlock(n, static_cast<int>(b)).text());
    if (lightsOutside()) all.push_back(OutputName::ofBlock("Cl", static_cast<int>(lightBlocks_.size())).text());
    return all;
}

bool Builder::lightsOutside() const { return !k_.facts.blocks.empty() && k_.facts.blocks.back() == kBlockOutside; }

/// "Cl#1" and the like of a light.
bool Builder::blockOutput(const std::string& name, const OutputName& asked) {
    const Type color{Base::Color, 0}, vector{Base::Vector, 0}, real{Base::Float, 0};
    bool found = false;
    for (size_t b = 0; b < lightBlocks_.size(); ++b) {
        const LightBlock& l = lightBlocks_[b];
        if (asked != OutputName::ofBlock(asked.name, static_cast<int>(b))) continue;
        if (asked.name == "L") putOut(name, get(l.L), vector), found = true;
        if (asked.name == "Cl") putOut(name, get(l.only ? globals_.at("Cl") : l.Cl), color), found = true;
        if (asked.name == "Ol") putOut(name, get(l.only ? globals_.at("Ol") : l.Ol), color), found = true;
        if (asked.name == "lit") putOut(name, get(l.lit), real), found = true;
    }
    if (asked != OutputName::ofBlock("Cl", static_cast<int>(lightBlocks_.size())) || !lightsOutside()) return found;
    putOut(name, emit(Op::Select, Kind::Triple, {get(blockRan_), zero(Kind::Triple), get(globals_.at("Cl"))}), color);
    return true;
}

/// "list[1]": an element of a parameter or of an output that outputchannel() makes.
void Builder::elementOutput(const std::string& name, const OutputName& asked) {
    Inst* list = nullptr;
    for (const ShaderParameter& p : shader_.parameters)
        if (p.symbol->name == asked.name && p.symbol->type.array && (p.symbol->output || asked.parameter))
            list = get(slot(p.symbol));
    if (const auto* c = channelNamed(asked.name); !list && c && c->second.array) list = get(c->first);
    const int length = !list ? 0 : lengths(list) ? list->index : arrayLength(list);
    if (asked.element >= 0 && asked.element < length) putOut(name, load(list, asked.element), {Base::Float, 0});
}

/// A parameter of the shader, or how it changes along u or v.
bool Builder::parameterOutput(const std::string& name, const OutputName& asked) {
    bool found = false;
    for (const ShaderParameter& p : shader_.parameters)
        for (const Op d : {Op::Du, Op::Dv})
            if (asked == OutputName::parameterOf(p.symbol->name, -1, d == Op::Du ? OutputName::What::Du : OutputName::What::Dv))
                if (Inst* v = get(slot(p.symbol)); v->kind == Kind::Float || v->kind == Kind::Triple)
                    putOut(name, emit(d, v->kind, {v}), p.symbol->type), found = true;
    for (const ShaderParameter& p : shader_.parameters)
        if (asked == OutputName::parameterOf(p.symbol->name) || (p.symbol->output && name == p.symbol->name)) {
            putOut(name, get(slot(p.symbol)), p.symbol->type);
            return true;
        }
    return found;
}

/// A predefined variable, or how it changes along u or v at the end of the shader.
void Builder::globalOutput(const std::string& name, const OutputName& asked) {
    for (const GlobalVariable& g : globalVariables(shader_.kind)) {
        const bool plain = name == g.name;
        if (!plain && asked != OutputName::du(g.name) && asked != OutputName::dv(g.name)) continue;
        const auto it = globals_.find(g.name);
        Inst* v = it == globals_.end() ? initialGlobal(g.name, g.type) : get(it->second);
        if (!plain) v = emit(asked.what == OutputName::What::Du ? Op::Du : Op::Dv, v->kind, {v});
        return putOut(name, v, g.type);
    }
}

void Builder::output(const std::string& name) {
    const OutputName asked = OutputName::parse(name);
    if (shader_.kind == ShaderKind::Light && !lightBlocks_.empty() && blockOutput(name, asked)) return;
    if (Type left; Inst* v = leftBehind(name, left)) return putOut(name, v, left);
    if (name.back() == ']') return elementOutput(name, asked);
    if (parameterOutput(name, asked)) return;
    if (Inst* given = channelGiven(name)) return putOut(name, given, {Base::Float, 0});
    if (Type type; Inst* v = channelValue(name, type)) return putOut(name, v, type);
    globalOutput(name, asked);
}

} // namespace alpenglow::rsl::ir

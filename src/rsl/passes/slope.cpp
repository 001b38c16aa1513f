#include "rsl/passes/slope.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/edit.h"
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/affine_weights.h"

namespace alpenglow::rsl::passes {

bool Weights::runToInputs(Inst* ci, const std::vector<Inst*>& inputs, int output) {
    home.resize(k.pool.size());
    index(k.body, nullptr, nullptr);
    WeightedValues outer;
    std::vector<Inst*> code;
    if (!scoped(k.body, code, {{ci->args[0], one()}}, outer)) return false;
    out = &code;
    Inst* sum = nullptr;
    for (Inst* i : inputs) {
        const auto it = inner.find(i);
        if (it != inner.end()) sum = sum ? emit(Op::Add, Kind::Triple, {sum, it->second}) : it->second;
    }
    Inst* o = k.make(Op::Output, Kind::None, {sum ? sum : zero()});
    o->index = output;
    code.push_back(o);
    out = nullptr;
    tails[&k.body] = std::move(code);
    assemble(k.body);
    return true;
}

void addSlope(Kernel& k) {
    bool requests = false;
    int ciOutput = -1;
    for (size_t n = 0; n < k.outputs.size(); ++n)
        if (k.outputs[n].name == "Ci") ciOutput = static_cast<int>(n);
    forEach(k.body, [&](Inst* i) { requests = requests || i->op == Op::Request; });
    if (requests || ciOutput < 0 || !analyseInput(k, "Ci").bad.empty()) return;
    // Work on a copy, so that a failure leaves the kernel as it was.
    Region original = k.body;
    CopyMap map;
    Region copy;
    copyBody(k, original, map, copy.body);
    k.body = copy;
    const Dependence d = analyseInput(k, "Ci");
    Inst* ci = nullptr;
    std::vector<Inst*> inputs;
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Output && i->index == ciOutput) ci = i;
        if (i->op == Op::Input && d.of(i)) inputs.push_back(i);
    });
    Weights weights(k, d);
    if (!ci || !weights.runToInputs(ci, inputs, static_cast<int>(k.outputs.size()))) {
        k.body = original;
        return;
    }
    k.outputs.push_back({OutputName::slope("Ci").text(), Kind::Triple, {Base::Color, 0}});
}

} // namespace alpenglow::rsl::passes

#include "rsl/passes/optimize.h"
#include "rsl/front/protocol.h"
#include "rsl/ir/edit.h"
#include "rsl/ir/verify.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/assume.h"
#include "rsl/passes/cse.h"
#include "rsl/passes/dce.h"
#include "rsl/passes/derivatives.h"
#include "rsl/passes/differences.h"
#include "rsl/passes/fold.h"
#include "rsl/passes/gradients.h"
#include "rsl/passes/ifconvert.h"
#include "rsl/passes/localmemory.h"
#include "rsl/passes/normal_side.h"
#include "rsl/passes/outline.h"
#include "rsl/passes/promote.h"
#include "rsl/passes/slope.h"
#include "rsl/passes/steadybakes.h"
#include "rsl/passes/unroll.h"
#include "rsl/passes/unused_results.h"
#include "rsl/passes/zerodivision.h"
#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace alpenglow::rsl::passes {
namespace {

void check([[maybe_unused]] const Kernel& k, [[maybe_unused]] const char* pass) {
#ifndef NDEBUG
    const std::string broken = verify(k);
    if (!broken.empty()) {
        std::fprintf(stderr, "IR broken after %s: %s\n", pass, broken.c_str());
        std::abort();
    }
#endif
}

void clean(Kernel& k) {
    for (int round = 0; round < 4; ++round) {
        int changes = fold(k);
        check(k, "fold");
        changes += assumeConditions(k);
        check(k, "assume");
        changes += mergeCommon(k);
        check(k, "cse");
        changes += removeDeadCode(k);
        check(k, "dce");
        if (changes == 0) break;
    }
}

/// Where direct light is asked for as well as indirectdiffuse(), none of both brings what is the other's: see kPairApart. A
/// kernel that does not wait has all calls of a point before its light is gathered; one that waits must know beforehand.
void tellApart(Kernel& k) {
    std::vector<Site*> direct, indirect;
    bool loops = false, always = false;
    const auto has = [](const Site& s, const char* pair) {
        return std::find(s.names.begin(), s.names.end(), pair) != s.names.end();
    };
    const auto hemisphere = [&](const Inst* i) {
        if (i->op != Op::Request && i->op != Op::Emit) return false;
        const Site& s = k.sites[static_cast<size_t>(i->site)];
        return s.op == "trace" && has(s, kPairHemisphere);
    };
    forEach(k.body, [&](const Inst* i) {
        if (i->op != Op::Request && i->op != Op::Emit && i->op != Op::LightLoop) return;
        Site& s = k.sites[static_cast<size_t>(i->site)];
        loops |= i->op == Op::LightLoop && !has(s, kPairHighlight);
        if (s.op == "diffuse") direct.push_back(&s);
        if (hemisphere(i)) indirect.push_back(&s);
    });
    if (indirect.empty() || (direct.empty() && !loops)) return;
    for (const Inst* i : k.body.body) always |= hemisphere(i);
    if (k.facts.suspends && always) indirect.insert(indirect.end(), direct.begin(), direct.end());
    for (Site* s : indirect) s->names.push_back(kPairApart), s->pairStrings.push_back("1");
}

} // namespace

void simplify(Kernel& k, const KernelOptions& options) {
    toLongForm(k);
    check(k, "build");
    inlineCalls(k, options.outline);
    check(k, "inline");
    if (options.optimize > 0) {
        clean(k);
        for (int round = 0; round < 3; ++round) {
            int changes = unrollLoops(k);
            check(k, "unroll");
            changes += promoteArrays(k);
            check(k, "promote");
            if (changes == 0) break;
            clean(k);
        }
        convertIfs(k);
        check(k, "ifconvert");
        clean(k);
    } else {
        removeDeadCode(k);
        check(k, "dce");
    }
}

std::vector<OutputLight> lightOfOutputs(Kernel& k, const KernelOptions& options) {
    simplify(k, options);
    std::vector<OutputLight> all;
    for (const OutputSlot& o : k.outputs) all.push_back({o, false});
    forEach(k.body, [&](Inst* i) {
        if (i->op == Op::Output) all[static_cast<size_t>(i->index)].light = needsLight(k, i);
    });
    return all;
}

void optimize(Kernel& k, const KernelOptions& options, Diagnostics& diagnostics) {
    simplify(k, options);
    if (options.optimize > 0 && warnOfZeroDivisions(k, diagnostics) > 0) clean(k);
    orderDerivatives(k, diagnostics); // warns of derivatives of rays while the rays are still there
    if (options.differences) {
        takeDifferences(k);
        check(k, "differences");
        if (options.optimize > 0) clean(k);
        else removeDeadCode(k);
    } else {
        addGradients(k);
        check(k, "gradients");
    }
    if (k.kind == ShaderKind::Volume &&
        std::find(options.outputs.begin(), options.outputs.end(), OutputName::slope("Ci").text()) != options.outputs.end()) {
        addSlope(k);
        check(k, "slope");
        if (options.optimize > 0) clean(k);
    }
    k.facts.suspends = false;
    if (options.suspend) {
        forEach(k.body, [&](Inst* i) { k.facts.suspends = k.facts.suspends || i->op == Op::Request; });
        k.facts.affine = nonAffineSites(k).empty();
    } else {
        makeAffine(k);
        check(k, "affine");
        if (options.optimize > 0) clean(k);
    }
    tellApart(k);
    markSteadyBakes(k);
    if (k.kind == ShaderKind::Surface)
        forEach(k.body, [&](const Inst* i) {
            if (i->op != Op::Output || k.outputs[static_cast<size_t>(i->index)].name != "Oi") return;
            const Inst* v = i->args[0];
            const bool one = isConst(v) && std::all_of(v->numbers.begin(), v->numbers.end(), [](float f) { return f == 1; });
            k.facts.opacity = one                                                                          ? "1"
                              : v->op == Op::Input && k.inputs[static_cast<size_t>(v->index)].name == "Os" ? "Os"
                                                                                                           : "shader";
        });
    if (options.optimize > 0) {
        removeUnusedResults(k);
        check(k, "unused results");
    }
    removeUnusedInputs(k);
    toShortForm(k);
    specialiseFunctions(k);
    check(k, "specialise");
    orderDerivatives(k, diagnostics);
    check(k, "derivatives");
    if (options.optimize > 0) readSideOfNormal(k);
    checkLocalMemory(k, diagnostics);
}

} // namespace alpenglow::rsl::passes

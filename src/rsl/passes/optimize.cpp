#include "rsl/passes/optimize.h"
#include "rsl/ir/edit.h"
#include "rsl/ir/verify.h"
#include "rsl/passes/affine.h"
#include "rsl/passes/assume.h"
#include "rsl/passes/cse.h"
#include "rsl/passes/dce.h"
#include "rsl/passes/derivatives.h"
#include "rsl/passes/fold.h"
#include "rsl/passes/ifconvert.h"
#include "rsl/passes/outline.h"
#include "rsl/passes/promote.h"
#include "rsl/passes/uniform.h"
#include "rsl/passes/unroll.h"
#include <cstdio>
#include <cstdlib>

namespace alpenglow::rsl::ir {
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

} // namespace

void optimize(Kernel& k, const KernelOptions& options, Diagnostics& diagnostics) {
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
    orderDerivatives(k, diagnostics); // warns of derivatives of rays while the rays are still there
    k.facts.suspends = false;
    if (options.suspend) {
        forEach(k.body, [&](Inst* i) { k.facts.suspends = k.facts.suspends || i->op == Op::Request; });
        k.facts.affine = nonAffineSites(k).empty();
    } else {
        makeAffine(k);
        check(k, "affine");
        if (options.optimize > 0) clean(k);
    }
    removeUnusedInputs(k);
    toShortForm(k);
    markUniform(k, options.mixed);
    specialiseFunctions(k);
    check(k, "specialise");
    orderDerivatives(k, diagnostics);
    check(k, "derivatives");
}

} // namespace alpenglow::rsl::ir

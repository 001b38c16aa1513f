// The order of the passes.
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include "rsl/kernel.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Of a kernel as it was built; changes it. In order of its outputs.
std::vector<OutputLight> lightOfOutputs(Kernel&, const KernelOptions&);

/// What comes before light and derivatives: inlining, folding, unrolling, conditions.
void simplify(Kernel&, const KernelOptions&);

/// Runs every pass; in builds with assertions the kernel is verified after each. At options.optimize == 0 only what changes
/// meaning or interface: affine form, derivative orders, uniformity, unused inputs.
void optimize(Kernel&, const KernelOptions&, Diagnostics&);

} // namespace alpenglow::rsl::passes

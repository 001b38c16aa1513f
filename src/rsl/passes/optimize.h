// The order of the passes.
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include "rsl/kernel.h"

namespace alpenglow::rsl::ir {

/// Runs every pass; in builds with assertions the kernel is verified after each. At options.optimize == 0 only what changes
/// meaning or interface: affine form, derivative orders, uniformity, unused inputs.
void optimize(Kernel&, const KernelOptions&, Diagnostics&);

} // namespace alpenglow::rsl::ir

// What a volume shader does to the light that comes in: Ci_out = a + slope Ci_in, by the affine proof with Ci as the unknown.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// For volume shaders: when the output Ci is affine in the incoming Ci, component by component, adds the output
/// OutputName::slope("Ci"), its coefficient. Else leaves the kernel as it is. Long form; kernels with Requests are left alone.
void addSlope(Kernel&);

} // namespace alpenglow::rsl::passes

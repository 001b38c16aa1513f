// Third part of the affine proof: the value of Ci without the results.
#pragma once
#include "rsl/passes/affine_analysis.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// The constant part a of Ci: results become zero, and what is only zero because of that disappears. Long form.
void dropResults(Kernel& k, const Dependence& d);

} // namespace alpenglow::rsl::passes

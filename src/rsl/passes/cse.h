// Common subexpressions: equal pure instructions are computed once, where the first dominates the second.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Long form. Returns the number of instructions removed.
int mergeCommon(Kernel&);

} // namespace alpenglow::rsl::passes

// Arrays that are only indexed by constants become values.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Long form. Returns the number of arrays removed.
int promoteArrays(Kernel&);

} // namespace alpenglow::rsl::passes

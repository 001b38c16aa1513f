// Arrays that are only indexed by constants become values.
#pragma once
#include "rsl/ir/ir.h"

namespace alpenglow::rsl::ir {

/// Long form. Returns the number of arrays removed.
int promoteArrays(Kernel&);

} // namespace alpenglow::rsl::ir

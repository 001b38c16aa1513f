// Small branches without effects become selects: cheaper than masks, and visible to the other passes.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

inline constexpr int kIfConvertCost = 12; ///< instructions on both sides together; square roots and divisions count as four

/// Long form. Returns the number of Ifs removed.
int convertIfs(Kernel&);

} // namespace alpenglow::rsl::passes

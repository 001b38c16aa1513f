// Constant folding and the algebraic identities that keep every bit.
#pragma once
#include "rsl/ir/edit.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// What `inst` (its operands known, not yet in a region) can be replaced by: one of its operands, a constant from `leaves`, or
/// null for no simplification. Derivatives are respected: an identity never replaces a value by one with other derivatives.
Inst* simplify(Kernel&, Leaves&, Inst* inst);

/// Folds the whole kernel; Ifs with constant conditions are replaced by the taken region. Returns the number of changes.
int fold(Kernel&);

} // namespace alpenglow::rsl::passes

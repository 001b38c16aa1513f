// Dead code: instructions without effect whose results are not used, and results and carried variables that are not needed.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Long form. Returns the number of changes.
int removeDeadCode(Kernel&);
/// Whether the result of some Request reaches an Output, as a value or by what is decided on it. Long form.
bool needsLight(Kernel&, Inst* output);
/// Drops the inputs that no instruction reads and renumbers the others.
void removeUnusedInputs(Kernel&);

} // namespace alpenglow::rsl::passes

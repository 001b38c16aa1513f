// Which values are equal in all lanes of a batch: flow-sensitive, so a `varying` variable with a uniform value costs a scalar.
#pragma once
#include "rsl/ir/ir.h"

namespace alpenglow::rsl::ir {

/// Sets Inst::varying everywhere. In build V (mixed) every input is varying. Long or short form.
void markUniform(Kernel&, bool mixed);

} // namespace alpenglow::rsl::ir

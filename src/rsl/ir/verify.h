// The rules that every kernel obeys between passes.
#pragma once
#include "rsl/ir/ir.h"
#include <string>

namespace alpenglow::rsl::ir {

/// Empty when the kernel is well formed, else the first rule broken, in words: every operand is defined before its use in the
/// same region or one around it; operand kinds fit the operation; regions have the parameters and yields their owner needs;
/// indices of inputs, outputs, sites and results exist.
std::string verify(const Kernel&);

} // namespace alpenglow::rsl::ir

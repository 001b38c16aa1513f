// The text of `alpenglow compile --dump-ir`.
#pragma once
#include "rsl/ir/ir.h"
#include <string>

namespace alpenglow::rsl::ir {

/// One instruction a line, regions indented. Values are %1, %2, ... in order of appearance, so equal kernels print equal texts.
/// After a value: its kind; `'` and `''` for first and second derivatives carried.
std::string print(const Kernel&);

} // namespace alpenglow::rsl::ir

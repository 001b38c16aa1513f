// What the condition of a branch or a loop implies about other booleans inside of it.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Inside the sides of an If its condition is a constant; inside the body of a Loop so are the carried flags that the test looks
/// at
/// (`while (!left && ...)`, as `break` and `return` leave it). Returns the number of uses replaced.
int assumeConditions(Kernel&);

} // namespace alpenglow::rsl::passes

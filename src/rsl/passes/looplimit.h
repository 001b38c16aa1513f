// Every loop that is left in a kernel gets a limit of turns (limits::kLoopIterations).
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Gives each Loop a site, after all others, that generated code calls for the points that reach the limit: a complaint with the
/// place of the loop. The points then go on behind the loop, with the values of that moment. Last of all passes; once a kernel.
void limitLoops(Kernel&);

} // namespace alpenglow::rsl::passes

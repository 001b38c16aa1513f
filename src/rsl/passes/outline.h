// User functions that are called, not inlined. The builder makes a Function of everything that may become one; here is decided
// which stay: large ones with several calls, and none that a ray's result goes through (the affine proof looks into everything).
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Inlines the calls of functions of at most `budget` instructions, of functions with one call (unless budget is 0), and of those
/// that are given a value that depends on a Request, the last as long as the kernel stays below limits::kAffineInlining. Long
/// form. Gives the number of calls inlined.
int inlineCalls(Kernel&, int budget);

/// A copy of each function for each set of derivative orders that its calls want of its results; calls with the same set share
/// one. Afterwards orderDerivatives() finds for each function exactly what is wanted.
void specialiseFunctions(Kernel&);

} // namespace alpenglow::rsl::passes

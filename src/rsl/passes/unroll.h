// Loops whose trip count follows from constants become straight code, so that octave loops and short kernels cost no control
// flow.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

inline constexpr int kUnrollTrips = 64;         ///< longer loops stay loops
inline constexpr int kUnrollInstructions = 768; ///< of one loop, unrolled

/// Long form. Returns the number of loops removed.
int unrollLoops(Kernel&);

} // namespace alpenglow::rsl::passes

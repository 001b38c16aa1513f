// A loop that sums up several results of rays, each weighted by something known only afterwards, as one loop a sum: the affine
// proof can then rescale the pairs of each loop as a whole.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Splits loops that carry several values which depend on rays, where no ray goes into two of them, none of them goes into
/// another, and the turns do nothing else that can be seen. The parts do again what they share. Long form. Gives the number of
/// loops split.
int splitSums(Kernel&);

} // namespace alpenglow::rsl::passes

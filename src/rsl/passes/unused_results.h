// Results of rays that nobody reads: who answers a request need not find out what is not asked.
#pragma once
#include "rsl/ir/ir.h"

namespace alpenglow::rsl::ir {

/// Takes the results that no instruction reads from the requests for traced light that are left, and from their sites. What a
/// site keeps is what some request of it reads.
void removeUnusedResults(Kernel&);

} // namespace alpenglow::rsl::ir

// Results of rays that are not read: the answer to a request need not compute them.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Takes the results that no instruction reads from the requests for traced light that are left, and from their sites. What a
/// site keeps is what some request of it reads.
void removeUnusedResults(Kernel&);

} // namespace alpenglow::rsl::passes

// The affine proof (docs/design/rsl.md): Ci = a + sum of w_i x_i in the results x_i of rays and lights. Where it holds the kernel
// does not wait: it returns a and emits the pairs (w_i, request).
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"
#include <string>
#include <utility>
#include <vector>

namespace alpenglow::rsl::passes {

/// Requests whose results are not used affinely in Kernel::light (Ci, mostly) alone, with the reason, in order of their sites.
/// Long or short form.
std::vector<std::pair<int, std::string>> nonAffineSites(const Kernel&);

/// Replaces every Request by an Emit (Mark and Rescale where the weight is only known after a loop) when all of them are affine;
/// else leaves the kernel as it is. Sets facts.affine, whyNot and suspends. Long form.
void makeAffine(Kernel&);

} // namespace alpenglow::rsl::passes

#include "rsl/passes/affine.h"
#include "rsl/ir/edit.h"
namespace alpenglow::rsl::ir {
std::vector<std::pair<int, std::string>> nonAffineSites(const Kernel&) { return {}; }
void makeAffine(Kernel&) {}
} // namespace alpenglow::rsl::ir

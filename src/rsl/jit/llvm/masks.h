// Masks between blocks, on machines without mask registers.
#pragma once
#include <llvm/IR/Module.h>

namespace alpenglow::rsl::jit {

/// Carries every mask that goes from one block to another as lanes of 32 bits, all ones or all zeros. Left as bits, the code
/// generator packs it at the end of one block and unpacks it at the start of the next, for every turn of a loop; comparisons
/// and blends below AVX-512 take and give whole lanes. To be run behind the last pass that simplifies, which would undo it.
void widenMasks(llvm::Module&);

} // namespace alpenglow::rsl::jit

// Masks between blocks, on machines without mask registers.
#pragma once
#include <llvm/IR/Module.h>

namespace alpenglow::rsl::jit {

/// Makes every mask that is combined with others, or goes from one block to another, lanes of 32 bits, all ones or all zeros.
/// Left as bits, the code generator packs it to bytes wherever masks meet and unpacks it where one is used, for every turn of a
/// loop; comparisons and blends below AVX-512 take and give whole lanes. `registerLanes` is how many lanes a register has: an
/// "any lane" test first joins the registers of a wide mask. To be run behind the last pass that simplifies, which would undo it.
void widenMasks(llvm::Module&, unsigned registerLanes);

} // namespace alpenglow::rsl::jit

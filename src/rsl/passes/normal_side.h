// Kernels that ask only on which side of the surface they are seen, as faceforward() does, take the unit geometric normal for Ng:
// its length needs partial derivatives, which cost more than the point.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Renames the input Ng of a surface to kSideNormal where nothing but signs depends on its length. In short form, with
/// derivatives ordered.
void readSideOfNormal(Kernel&);

} // namespace alpenglow::rsl::passes

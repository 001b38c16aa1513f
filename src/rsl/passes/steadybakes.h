// Which calls of bake() and bake3d() all points of a primitive reach, or none of them.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Gives sites of bake() and bake3d() the pair kPairSteady where their files and the conditions on the way to them follow from
/// parameters, attributes of the user, options and what the ray is.
void markSteadyBakes(Kernel&);

} // namespace alpenglow::rsl::passes

// How much memory a kernel's local arrays take.
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Bytes that the local arrays of a kernel whose derivatives are ordered (passes/derivatives.h) take for one point at most, those
/// of its functions included.
size_t localArrayBytes(const Kernel&);
/// An error at the largest array when that is more than limits::kShaderMemory. The same for every number of lanes.
void checkLocalMemory(const Kernel&, Diagnostics&);

} // namespace alpenglow::rsl::passes

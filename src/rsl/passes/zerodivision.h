// Divisions by a constant zero that are left in what a kernel runs: they give 0, and a shader that has one is often only black.
#pragma once
#include "base/diagnostics.h"
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Inst::index of a Div that stands in the text of a shader, not in that of a shadeop. One whose divisor is a constant zero is
/// not folded: only when dead code is gone is it known whether it runs.
inline constexpr int kWrittenDivision = 1;

/// Whether folding must leave it.
bool waitsForWarning(const Inst&);
/// Warns of each at its place, and frees them to be folded. Returns how many there were.
int warnOfZeroDivisions(Kernel&, Diagnostics&);

} // namespace alpenglow::rsl::passes

// Derivatives as a grid of micropolygons has them.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"

namespace alpenglow::rsl::passes {

/// Puts differences in the place of Du and Dv: the values that they reach are worked out at the point and one step of du and dv
/// on, and Du(x) becomes (x(u + du, v) - x(u, v)) / du. What is left of Du and Dv is of inputs, whose derivatives the renderer
/// gives: a neighbour has the inputs that they lead to. Sums of inputs keep their exact derivative, which is the same number. A
/// derivative of a derivative looks two steps on. Within a branch or a loop of its own the neighbour follows the point; what
/// comes out of one is worked out on the neighbour's own branch. Results of rays and lights are those of the point. Long form.
/// Source: Cook, Carpenter, Catmull 1987 (derivatives on the grid); RISpec 3.2, 15.1.
void takeDifferences(Kernel&);

} // namespace alpenglow::rsl::passes

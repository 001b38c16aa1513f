// Derivatives through texture() and environment().
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/passes/names.h"
#include <vector>

namespace alpenglow::rsl::passes {

/// Which arguments of a lookup are its coordinates, in order: s and t, or a direction; four of each where corners are given. The
/// others say how wide the filter is, and what else.
std::vector<size_t> lookupCoordinates(const Kernel&, const Inst* service);

/// Where derivatives of a lookup (DerivativeRule::Gradient) are wanted, by Inst::order: asks the service for the slopes of the
/// value by its coordinates, too (s and t, or x, y and z of the direction; of four corners: their mean), where second derivatives
/// are wanted for those of the value (ss st tt, or xx xy xz yy yz zz), and puts the value together with the derivatives of the
/// coordinates, al_chain*. Other lookups stay as they are. Long form, after orderDerivatives().
void addGradients(Kernel&);

} // namespace alpenglow::rsl::passes

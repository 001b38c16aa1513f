// From the checked tree to IR: variables become values, functions disappear, spaces become matrices.
#pragma once
#include "rsl/ir/ir.h"
#include "rsl/kernel.h"
#include "rsl/passes/optimize.h"
#include <memory>

namespace alpenglow::rsl {

/// The kernel of one shader under `options`: user functions and RSL shadeops inlined, string parameters constant, outputs chosen.
/// Lobe calls (diffuse, specular, ...) under options.path are Requests where the result is used affinely, else RSL light loops
/// (noted in facts.direct). Reports what cannot be compiled (limits::kInlinedInstructions, third-order derivatives, ...) with its
/// place. Null after an error. Run optimize() (passes/optimize.h) on the result before generating code.
///
/// Predefined variables at the start: surface Ci = 0, Oi = Os; light Cl = 0, Ol = 1; all others come from inputs of their name.
/// Results of blocks of a light: outputs "L", "Cl", "Ol", "lit" (1 inside the cone), with "#b" appended for block b > 0; an
/// ambient light has "Cl" and "Ol" only. Output shader parameters appear under their own name, any parameter as "param:NAME" on
/// request.
std::unique_ptr<ir::Kernel> buildKernel(const Program&, const Shader&, const KernelOptions&, Diagnostics&);

/// The outputs that a kernel under `options` would have, in order, and whether light that is asked for (KernelOptions::path says
/// which calls ask) reaches them, as a value or by what is decided on it. Empty after an error.
std::vector<ir::OutputLight> lightOfOutputs(const Program&, const Shader&, const KernelOptions& options);

/// A kernel whose outputs "param:NAME" (arrays: "param:NAME[i]") are the parameters' defaults, in declaration order.
/// `given`: values of parameters, in place of their defaults.
std::unique_ptr<ir::Kernel> buildDefaults(const Program&, const Shader&, Diagnostics&,
                                          const std::vector<ParameterValue>& given = {});

} // namespace alpenglow::rsl

// Places where a surface shader cannot be separated from the light that it requests: the warnings "not-affine" of `compile -W`
// and of the language server.
#pragma once
#include "base/diagnostics.h"
#include "rsl/kernel.h"
#include <vector>

namespace alpenglow::rsl {

struct Program;
struct Shader;

/// Every call whose result, under Hider "path", goes through something else than sums and products with what is known beforehand:
/// light that this shader asks for, and then waits for. In the order of the text; empty when there is none. Warnings without
/// their line of text (Diagnostic::sourceLine); the file is empty when the place is not known.
std::vector<Diagnostic> nonlinearUses(const Program&, const Shader&, KernelOptions);

} // namespace alpenglow::rsl

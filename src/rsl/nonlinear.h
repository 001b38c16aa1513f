// Where a surface shader cannot be split from the light it asks for: the warning "not-affine" of `compile -W` and of the language
// server.
#pragma once
#include "base/diagnostics.h"
#include "rsl/kernel.h"
#include <optional>

namespace alpenglow::rsl {

struct Program;
struct Shader;

/// The first place at which, under Hider "path", light that this shader asks for goes through something else than sums and products
/// with what is known beforehand: the shader then waits for its rays. Nothing when there is none. A warning without its line of text
/// (Diagnostic::sourceLine); the file is empty when the place is not known.
std::optional<Diagnostic> nonlinearUse(const Program&, const Shader&, KernelOptions);

} // namespace alpenglow::rsl

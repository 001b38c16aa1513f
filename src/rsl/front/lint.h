// Warnings that only who writes a shader wants to see (`compile -W`, the language server): a renderer that loads a shader from 1995
// keeps quiet about them.
#pragma once
#include "rsl/front/source.h"

namespace alpenglow::rsl::front {

/// Looks through a checked program and warns about parameters and variables of the main file that nothing uses, variables that are
/// read before they have a value, and uniform variables that are changed where a varying condition holds. Trees with errors in them
/// are looked at as far as they go.
void lint(const Program&, SourceSet&);

} // namespace alpenglow::rsl::front

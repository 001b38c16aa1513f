// Shader objects: a class becomes one ordinary shader for each kind of shader that its methods make it (rsl.md 7.2). Members are
// variables of that shader's body, methods functions nested in it.
#pragma once
#include "rsl/front/parser.h"

namespace alpenglow::rsl::front {

/// Adds the shaders of the unit's classes to its shaders. Problems are reported.
void expandClasses(Unit&, SourceSet&);

} // namespace alpenglow::rsl::front

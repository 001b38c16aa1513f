// Shader objects (3Delight manual, 6.1.1.2): a class becomes one ordinary shader for each kind that its methods make it. Members
// are variables of that shader's body, methods functions nested in it.
#pragma once
#include "rsl/front/parser.h"

namespace alpenglow::rsl::front {

/// Adds the shaders of the unit's classes to its shaders. Problems are reported.
void expandClasses(Unit&, SourceSet&);

} // namespace alpenglow::rsl::front

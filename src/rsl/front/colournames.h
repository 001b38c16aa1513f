// Names of colour spaces that are written down.
#pragma once
#include "rsl/front/ast.h"
#include "rsl/front/source.h"

namespace alpenglow::rsl::front {

/// Warns where ctransform() or `color "name" (...)` names an unknown space (rsl.md 10.6: the colour stays as it is), each name
/// once. Names that are known only when the shader is bound or runs are the builder's and the renderer's.
void checkColourNames(const Program&, SourceSet&);

} // namespace alpenglow::rsl::front

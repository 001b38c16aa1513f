// Names of colour spaces that are written down.
#pragma once
#include "rsl/front/ast.h"
#include "rsl/front/source.h"

namespace alpenglow::rsl::front {

/// Warns where ctransform() or `color "name" (...)` names an unknown space, each name once: the colour stays
/// as it is (3Delight manual, 6.4.3). Names that are known only later are the builder's and the renderer's.
void checkColourNames(const Program&, SourceSet&);

} // namespace alpenglow::rsl::front

// Takes apart a mesh where more than two faces share an edge, neighbours do not agree which way round they go, or faces share a vertex but
// no edges there: each sheet gets vertices of its own, and its border there is sharp.
#pragma once
#include "geometry/limit_surface.h"

namespace alpenglow::geometry {

struct ManifoldCage {
    SubdivisionCage cage;         ///< looks at `vertex`, and at the corner counts of the cage that it was made of
    std::vector<int> vertex;      ///< per corner
    std::vector<int> original;    ///< per vertex of `cage`, that of the cage it was made of
};

ManifoldCage makeManifold(const SubdivisionCage&);

} // namespace alpenglow::geometry

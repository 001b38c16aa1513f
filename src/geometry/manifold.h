// Takes apart a mesh where more than two faces share an edge, neighbours do not agree which way round they go, or faces share a
// vertex but no edges there: each sheet gets vertices of its own, and what tore is its border. Creases and corners are lost with
// that: OpenSubdiv 3.5 reads memory that it has not written for some of those at such borders.
#pragma once
#include "geometry/limit_surface.h"

namespace alpenglow::geometry {

struct ManifoldCage {
    SubdivisionCage cage;      ///< looks at `vertex`, and at the corner counts of the cage that it was made of
    std::vector<int> vertex;   ///< per corner
    bool blunted = false;      ///< creases or corners were lost
    std::vector<int> original; ///< per vertex of `cage`, that of the cage it was made of
};

ManifoldCage makeManifold(const SubdivisionCage&);

} // namespace alpenglow::geometry

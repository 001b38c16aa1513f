// Takes apart a mesh where more than two faces share an edge, neighbours do not agree which way round they go, or faces share a vertex but
// no edges there: each sheet gets vertices of its own, and its border there is sharp. Semi-sharp creases and corners become smooth below
// 2 and sharp above: OpenSubdiv 3.5 reads memory that it has not written for some that end at such vertices.
#pragma once
#include "geometry/limit_surface.h"

namespace alpenglow::geometry {

struct ManifoldCage {
    SubdivisionCage cage;         ///< looks at `vertex`, and at the corner counts of the cage that it was made of
    std::vector<int> vertex;      ///< per corner
    bool rounded = false;         ///< there were semi-sharp ones
    std::vector<int> original;    ///< per vertex of `cage`, that of the cage it was made of
};

ManifoldCage makeManifold(const SubdivisionCage&);

} // namespace alpenglow::geometry

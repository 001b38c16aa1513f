// Separates non-manifold meshes: where more than two faces share an edge, neighbours have opposite winding, or faces share a
// vertex but no edge. Each sheet gets its own vertices, and the cuts become borders. Creases and corners there are dropped,
// because OpenSubdiv 3.5 reads uninitialised memory for some at such borders.
#pragma once
#include "geometry/limit_surface.h"

namespace alpenglow::geometry {

/// The separated cage.
struct ManifoldCage {
    SubdivisionCage cage;      ///< refers to `vertex`, and to the corner counts of the original cage
    std::vector<int> vertex;   ///< per corner
    bool blunted = false;      ///< creases or corners were lost
    std::vector<int> original; ///< per vertex of `cage`: vertex of the original
};

/// The original must outlive the result, which refers to it.
ManifoldCage makeManifold(const SubdivisionCage&);

} // namespace alpenglow::geometry

// Division of a quadrilateral or triangle into facets with a separate rate for each edge.
#pragma once
#include "base/vec.h"
#include <cstdint>
#include <vector>

namespace alpenglow::geometry {

/// The facets of one piece, in its own u and v.
struct PieceGrid {
    std::vector<Vec2>
        param;      ///< the border first, from corner 0 by winding: corner, points of the edge, corner ..; then the inside
    int border = 0; ///< number of points on the border
    std::vector<uint32_t> facet; ///< three a triangle, wound as the piece

    /// rates: segments of each edge, all at least 1; 4 edges (corners (0,0) (1,0) (1,1) (0,1)) or 3 ((0,0) (1,0) (0,1)).
    static PieceGrid make(const int* rates, int edges);
};

} // namespace alpenglow::geometry

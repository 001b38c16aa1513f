// Borders of subdivision surfaces as edge curves (edge_curve.h): there the limit depends on border vertices only, for all
// schemes, so separate meshes with the same vertices along an edge have the same points on it, bit by bit.
#pragma once
#include "geometry/edge_curve.h"
#include "geometry/limit_surface.h"
#include <functional>
#include <utility>
#include <vector>

namespace alpenglow::geometry {

/// The border edges of one cage.
class CageBorder {
public:
    /// Before LimitSurface::forgetTopology().
    CageBorder(const SubdivisionCage&, const LimitSurface&);
    /// Edges (by LimitSurface's numbers) whose limit is a cubic or a line that depends on their ends and neighbours only. Border
    /// edges with semi-sharp creases or corners are excluded.
    const std::vector<int>& edges() const { return edges_; }
    /// The limit on edges()[k], from the edge's first vertex; point: of a vertex, camera space.
    EdgeCurve curve(size_t k, const std::function<Vec3d(int)>& point) const;
    /// The vertices that edges()[k] runs between.
    std::pair<int, int> ends(size_t k) const { return {ends_[k].first, ends_[k].last}; }

private:
    static constexpr int kCorner = -1; ///< in place of a neighbour: the curve passes through the end with zero curvature
    struct Ends {
        int before, first, last, behind;
    };
    std::vector<int> edges_;
    std::vector<Ends> ends_;
    bool straight_ = false;
};

} // namespace alpenglow::geometry

// Borders of subdivision surfaces as edges of their own (edge_curve.h): the limit there depends on the vertices of the border
// alone, whatever the scheme, so that separate meshes with the same vertices along an edge have the same points on it to the
// bit.
#pragma once
#include "geometry/edge_curve.h"
#include "geometry/limit_surface.h"
#include <functional>
#include <utility>
#include <vector>

namespace alpenglow::geometry {

class CageBorder {
public:
    /// Before LimitSurface::forgetTopology().
    CageBorder(const SubdivisionCage&, const LimitSurface&);
    /// Edges (by LimitSurface's numbers) whose limit is a cubic or a line that their ends and what is next to these decide.
    /// Others of the border, where creases or corners are semi-sharp, have none.
    const std::vector<int>& edges() const { return edges_; }
    /// The limit on edges()[k], from the edge's first vertex; point: of a vertex, camera space.
    EdgeCurve curve(size_t k, const std::function<Vec3d(int)>& point) const;
    /// The vertices that edges()[k] runs between.
    std::pair<int, int> ends(size_t k) const { return {ends_[k].first, ends_[k].last}; }

private:
    static constexpr int kCorner = -1; ///< in place of a neighbour: the surface goes through the end, and bends no more there
    struct Ends {
        int before, first, last, behind;
    };
    std::vector<int> edges_;
    std::vector<Ends> ends_;
    bool straight_ = false;
};

} // namespace alpenglow::geometry

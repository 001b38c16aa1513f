// Octrees over points of surfaces, one for each of the six axes that a normal can be nearest to: a cell for each place and side.
// Guides keep what they learned there (causticguide.h, radianceguide.h).
#pragma once
#include "base/vec.h"
#include "world/names.h"
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alpenglow::world {

/// Cells over the points of surfaces. Immutable once it is built.
class SurfaceTree {
public:
    static constexpr int kSides = 6; ///< the six axes
    /// A point of a surface. Camera space.
    struct Point {
        Vec3 P;       ///< position
        int side = 0; ///< sideOf() the normal on the lit side
    };
    /// The axis nearest to a unit normal, 1 to kSides.
    static int sideOf(const Vec3& n) {
        const Vec3 a(std::fabs(n.x), std::fabs(n.y), std::fabs(n.z));
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        return 1 + 2 * axis + (n[axis] < 0);
    }
    /// The unit vector along an axis, 1 to kSides.
    static Vec3 axisOf(int side) {
        Vec3 n(0.f);
        n[(side - 1) / 2] = side % 2 ? 1.f : -1.f;
        return n;
    }

    /// A cell that is being made.
    struct Leaf {
        std::span<const uint32_t> points; ///< indices
        std::span<const uint32_t> around; ///< of the cell that was divided; empty: none was
        int32_t& ofAround;                ///< what the maker keeps for all cells with this `around`; -1 at first
        int side;                         ///< as Point::side
        float size;                       ///< edge of its cube
    };
    /// Divides cells of more than `split` points. Axes with fewer than `fewest` points have no cells. make() returns the number
    /// of a cell, 0 or more.
    void build(std::span<const Point>, size_t split, size_t fewest, const std::function<int32_t(const Leaf&)>& make);
    /// The cell of a place on a side; -1: none.
    int32_t find(const Vec3& P, int side) const;
    /// The same for several points at once, level by level, so that their memory accesses overlap. At most kTogether points.
    static constexpr size_t kTogether = 16;
    void find(std::span<const Point>, int32_t* cells) const;
    float edge() const { return edge_; } ///< of the cube around all points

private:
    static constexpr int kLevels = 16; ///< halvings of the cube
    struct Place {
        uint32_t x, y, z;
    };
    bool placeOf(const Vec3&, Place&) const;
    struct Builder;
    Vec3 corner_; ///< of the cube
    float edge_ = 0;
    float perSize_ = 0;              ///< 2^kLevels over its edge
    std::vector<int32_t> nodes_;     ///< eight children each: index of a node, or -1 - cell
    int32_t roots_[kSides + 1] = {}; ///< by side, or kNone; valid if edge_ > 0
};

} // namespace alpenglow::world

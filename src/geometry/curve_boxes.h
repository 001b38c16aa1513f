// Boxes and capsules around primitives of curves: equal parts of segments. Camera space.
#pragma once
#include "geometry/capsule.h"
#include "geometry/curves.h"
#include "geometry/shape.h"

namespace alpenglow::geometry {

/// For one key; its sources must outlive it.
class CurveBoxes {
public:
    /// parts: into how many primitives a segment is cut.
    CurveBoxes(const CurveSet&, const Matrix& toCamera, uint32_t parts);
    /// Of primitives that follow one another.
    void bounds(uint32_t first, std::span<Bounds> out) const;
    /// Whether the fast path applies: segments are cubic, and the space is affine.
    bool quick() const { return !set_.linear() && affine_; }
    /// They may be a little larger, but end at `all`.
    void quickBounds(uint32_t first, std::span<Bounds> out, const Bounds& all) const;
    /// Capsules of consecutive primitives, from `first` on.
    void capsules(uint32_t first, std::span<Capsule> out) const;

private:
    Vec3d toCamera(const Vec3d& p) const;
    int hull(const CurveSegment&, uint32_t prim, Vec3d p[4]) const;
    Vec3d reachOf(double wide) const;
    template <class Out, class F> void eachPiece(uint32_t first, std::span<Out> out, F f) const;

    const CurveSet& set_;
    const Matrix& toCamera_;
    uint32_t parts_;
    bool affine_;
    double reach_[3]; ///< half the extent of a unit ball of object space along camera axes
    double stretch_;  ///< no direction of object space becomes longer
};

} // namespace alpenglow::geometry

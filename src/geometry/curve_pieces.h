// Boxes and capsules of the pieces of a cubic segment, for building trees: in single precision relative to the start of the
// segment, with a margin for rounding. Camera space.
#pragma once
#include "geometry/capsule.h"
#include "geometry/shape.h"
#include <array>
#include <vector>

namespace alpenglow::geometry {

/// One segment at a time, cut into the same number of parts.
class CurvePieces {
public:
    /// For this number of equal parts.
    explicit CurvePieces(uint32_t parts);
    /// The Bezier points of a segment. Half its width: `wide` at the most, `reach` along each axis.
    void take(const Vec3d p[4], double wide, const Vec3d& reach);
    /// Holds a part, and is hardly larger than its control points.
    Bounds box(uint32_t part) const;
    /// Holds a part and its width.
    Capsule capsule(uint32_t part) const;

private:
    typedef float Four __attribute__((vector_size(16)));
    void points(uint32_t part, Four p[4]) const;
    std::vector<std::array<float, 16>> weights_; ///< by part, of the segment's points by those of the part
    Vec3d base_;
    Four from_[4], reach_; ///< from base_
    double wide_ = 0, size_ = 0;
};

} // namespace alpenglow::geometry

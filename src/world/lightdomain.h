// The directions from which a light can come, divided into bins: parts of a flat emitter, or of the sphere for a sky.
#pragma once
#include "base/vec.h"
#include "lanes/blocks.h"
#include "world/names.h"

namespace alpenglow::world {

/// The bins of one light. Directions are those from the lit point.
class LightDomain {
public:
    static constexpr int kMostBins = 384; ///< most bins of a domain
    LightDomain() = default;              ///< of a sky
    /// Of an emitter whose triangles lie in one plane: squares of the smallest rectangle around it that is parallel to one of its
    /// edges.
    explicit LightDomain(const FlatEmitter&);
    int bins() const { return flat_ ? kEdge * kEdge : 6 * kFace * kFace; }
    /// The bin in a unit direction w from P, and the density per steradian there of directions that direction() draws within the
    /// bin. Returns false if there is none.
    bool find(const Vec3& P, const Vec3& w, int& bin, float& density) const;
    /// A unit direction from P into a bin. u: each in [0, 1).
    Vec3 direction(const Vec3& P, int bin, Vec2 u) const;

private:
    static constexpr int kEdge = 8; ///< bins along each side of the rectangle
    static constexpr int kFace = 8; ///< bins along an edge of a cube around P: directions of a sky
    bool flat_ = false;
    Vec3 corner_, edge_[2], per_[2]; ///< the rectangle; a place's coordinates, 0 to 1, are its products with per_
    Vec3 n_;                         ///< unit
    float area_ = 0;                 ///< of a bin
};

} // namespace alpenglow::world

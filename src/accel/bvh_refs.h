// References during construction of trees. Internal to accel.
#pragma once
#include "accel/bvh_boxes.h"
#include <cstring>

namespace alpenglow::accel {

/// Consecutive triangles, or a primitive of an exact shape; its index, or that of the first triangle, is in the fourth lane of
/// the lower corner, and their number in that of the upper one.
struct Ref {
    Four lo, hi; ///< corners of the box
    /// Index of the first triangle, or of the exact primitive.
    uint32_t id() const {
        const float f = lo[3];
        uint32_t i;
        std::memcpy(&i, &f, 4);
        return i;
    }
    /// Sets id(), bit by bit: as a number it may be a NaN.
    void setId(uint32_t i) {
        float f;
        std::memcpy(&f, &i, 4);
        lo[3] = f;
    }
    /// Number of triangles.
    uint32_t many() const { return uint32_t(hi[3]); }
    /// Twice the centre of the box; the fourth lane is meaningless.
    Four twiceCentre() const { return lo + hi; }
};

/// Consecutive references, the box of their contents, and the box of their centres (twice their value).
struct Range {
    size_t begin = 0, end = 0; ///< of references
    Box box, centres;
    bool leaf = false; ///< becomes a leaf: its references are not divided
    /// Number of references.
    size_t size() const { return end - begin; }
};

/// For one primitive of an exact shape; NaN bounds become infinite.
Ref refOf(uint32_t id, const geometry::Bounds&);
/// Whether a box is beyond Bvh::kFarthest: such references are left out.
inline bool tooFar(const Ref& r) {
    return Bvh::reaches({r.lo[0], r.lo[1], r.lo[2]}) || Bvh::reaches({r.hi[0], r.hi[1], r.hi[2]});
}

/// Number of triangles from this one on for one reference. Triangles of a grid come in rows, two to a quad: takes as many
/// consecutive neighbours as a leaf holds. So a tree over a diced surface is built over its leaves.
uint32_t together(const geometry::TriMesh&, uint32_t from, uint32_t to);

/// 2 if this triangle and the next share an edge and their box is hardly larger than that of one of them (halves of a quad), else
/// 1.
uint32_t pair(const geometry::TriMesh&, uint32_t from, uint32_t to);

} // namespace alpenglow::accel

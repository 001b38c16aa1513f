// What trees are built of. Not for other rooms.
#pragma once
#include "accel/tree_boxes.h"
#include <cstring>

namespace alpenglow::accel {

/// Triangles that follow one another, or a primitive of an exact shape; its number, or that of the first of them, lies in the
/// fourth lane of the lower corner, and how many they are in that of the upper one.
struct Ref {
    Four lo, hi;
    uint32_t id() const {
        const float f = lo[3];
        uint32_t i;
        std::memcpy(&i, &f, 4);
        return i;
    }
    void setId(uint32_t i) {
        float f;
        std::memcpy(&f, &i, 4);
        lo[3] = f;
    }
    uint32_t many() const { return uint32_t(hi[3]); }
    Four twiceCentre() const { return lo + hi; }
};

struct Range {
    size_t begin = 0, end = 0; ///< of references
    Box box, centres;
    bool leaf = false;
    size_t size() const { return end - begin; }
};

/// Of one primitive of an exact shape: what of its box is no number reaches as far as can be.
Ref refOf(uint32_t id, const geometry::Bounds&);
inline bool tooFar(const Ref& r) {
    return Tree::reaches({r.lo[0], r.lo[1], r.lo[2]}) || Tree::reaches({r.hi[0], r.hi[1], r.hi[2]});
}

/// How many triangles from this one on make one reference. Those of a grid come row by row, a quad's two together: as many as
/// a leaf holds, which are neighbours one after the other. So a tree over a diced surface is built over its leaves.
uint32_t together(const geometry::TriMesh&, uint32_t from, uint32_t to);

/// 2 where this triangle and the next share an edge and fill a box that is hardly larger than that of one of them: halves of a
/// quad. Otherwise 1.
uint32_t pair(const geometry::TriMesh&, uint32_t from, uint32_t to);

} // namespace alpenglow::accel

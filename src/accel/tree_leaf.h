// Leaves of triangles, made of references. Not for other rooms.
#pragma once
#include "accel/tree_refs.h"

namespace alpenglow::accel {

/// Of a tree whose triangles are numbered. References are to triangles here.
struct LeafMaker {
    const Tree& tree;
    std::span<const geometry::ShapeRef> shapes;
    /// Whether they make one leaf: no more triangles and corners than it holds.
    bool fits(std::span<const Ref>) const;
    /// The leaf of what fits; false: it has more corners than that, and nothing is written. null: only this is asked.
    bool make(std::span<const Ref>, Tree::Leaf* out) const;
};

} // namespace alpenglow::accel

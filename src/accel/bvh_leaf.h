// Makes leaves of triangles from references. Internal to accel.
#pragma once
#include "accel/bvh_refs.h"

namespace alpenglow::accel {

/// For a tree with numbered triangles. References are to triangles here.
struct LeafMaker {
    const Bvh& tree;
    std::span<const geometry::ShapeRef> shapes; ///< as given to Bvh::build()
    /// Whether they fit into one leaf, by number of triangles and corners.
    bool fits(std::span<const Ref>) const;
    /// Makes the leaf; returns false, without writing, if there are too many corners. null: tests only.
    bool make(std::span<const Ref>, Bvh::Leaf* out) const;
};

} // namespace alpenglow::accel

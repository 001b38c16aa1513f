// Rays against the box's twelve triangles and two spheres by Embree alone: what traversal costs at the least.
#pragma once
#include "accel/accel.h"
#include <span>

namespace alpenglow::bench {

class BareEmbree {
public:
    /// Polygons as their triangles, spheres as Embree's own spheres.
    explicit BareEmbree(std::span<const geometry::ShapeRef>);
    ~BareEmbree();
    /// Rays that meet something.
    size_t intersect(std::span<const accel::Ray>) const;

private:
    void* device_ = nullptr;
    void* scene_ = nullptr;
};

} // namespace alpenglow::bench

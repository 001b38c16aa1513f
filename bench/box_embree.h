// Rays against shapes by Embree alone: what traversal costs elsewhere.
#pragma once
#include "accel/accel.h"
#include <span>

namespace alpenglow::bench {

class BareEmbree {
public:
    /// Meshes as their triangles, what is placed as an instance, curves as Embree's round curves and spheres as its own; other
    /// exact shapes are left out. Robust. All stand still.
    explicit BareEmbree(std::span<const geometry::ShapeRef>);
    ~BareEmbree();
    BareEmbree(const BareEmbree&) = delete;
    BareEmbree& operator=(const BareEmbree&) = delete;
    /// Rays that meet something. t, if it is not null: where each does, infinite where nothing is.
    size_t intersect(std::span<const accel::Ray>, float* t = nullptr) const;
    size_t occluded(std::span<const accel::Ray>, uint8_t* met = nullptr) const;

private:
    void* device_ = nullptr;
    void* scene_ = nullptr;
};

} // namespace alpenglow::bench

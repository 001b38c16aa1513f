// Kernels that run while nobody follows rays: while a world is made, and over finished pixels. The integrator has what runs them.
#pragma once
#include "world/bound.h"
#include <functional>
#include <span>

namespace alpenglow::transport {

/// One thread's. What a kernel's callbacks threw is thrown again.
class Evaluator {
public:
    virtual ~Evaluator() = default;
    /// Runs a kernel that does not wait over points that no ray has met, all with the values of one shader. `of`: the surface
    /// that they belong to, null: none. `take` sees the outputs; the points are as they were.
    virtual void run(const BoundKernel&, const SurfaceBinding* of, std::vector<ShadePoint>& points, const shading::InstanceView&,
                     const std::function<void(const shading::Batch&)>& take) = 0;
    /// Light arriving at points (ShadePoint::Ps) from one light.
    virtual void light(const BoundLight&, std::vector<ShadePoint>&, std::span<LightValue>) = 0;
};

} // namespace alpenglow::transport

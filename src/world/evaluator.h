// Runs kernels outside of ray tracing: while a world is built, and over finished pixels. Implemented by the integrator.
#pragma once
#include "world/bound.h"
#include <functional>
#include <span>

namespace alpenglow::world {

/// For one thread. Rethrows exceptions of kernel callbacks.
class Evaluator {
public:
    virtual ~Evaluator() = default;
    /// Runs a kernel that does not wait over points without rays, with the parameters of one shader. `of`: the surface that the
    /// points belong to, or null. `take` receives the outputs; the points are left unchanged.
    virtual void run(const BoundKernel&, const SurfaceBinding* of, std::vector<ShadePoint>& points, const shading::InstanceView&,
                     const std::function<void(const shading::Batch&)>& take) = 0;
    /// Evaluates the light from one light at points (ShadePoint::Ps).
    virtual void light(const BoundLight&, std::vector<ShadePoint>&, std::span<LightValue>) = 0;
};

} // namespace alpenglow::world

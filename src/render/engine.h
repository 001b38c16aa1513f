// Interface from render/ to the integrator: a pair of functions, so that tests can replace it by a scene of closed forms.
#pragma once
#include "base/stopflag.h"
#include "integrator/integrator.h"
#include <functional>
#include <memory>
#include <span>

namespace alpenglow::render {

/// Traces the rays of one thread. See integrator::Integrator.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// integrator::Integrator::trace().
    virtual bool trace(std::span<const integrator::CameraRay>, std::span<integrator::SampleResult>, const StopFlag* stop) = 0;
    /// Of all calls so far.
    virtual const integrator::Counters& counters() const = 0;
    virtual bool seesNothing(std::span<const geometry::Plane>) const { return false; } ///< see integrator::Integrator
    /// See integrator::Integrator.
    virtual bool unfinished() const { return false; }
};

/// The pair.
struct Engine {
    /// As World::build().
    std::function<std::shared_ptr<const world::World>(std::shared_ptr<const scene::Frame>, const world::Settings&, Diagnostics&)>
        build;
    /// For one thread.
    std::function<std::unique_ptr<Tracer>(std::shared_ptr<const world::World>, Diagnostics&)> tracer;
};

/// The renderer's own engine: buildWorld() and Integrator.
Engine transportEngine();

} // namespace alpenglow::render

// Interface from render/ to the integrator: a pair of functions, so that tests can replace it by a scene of closed forms.
#pragma once
#include "base/stopflag.h"
#include "integrator/integrator.h"
#include <functional>
#include <memory>
#include <span>

namespace alpenglow::transport {
struct BounceTally;
}

namespace alpenglow::render {

/// Traces the rays of one thread. See transport::Integrator.
class Tracer {
public:
    virtual ~Tracer() = default;
    virtual bool trace(std::span<const transport::CameraRay>, std::span<transport::SampleResult>, const StopFlag* stop) = 0;
    virtual const transport::Counters& counters() const = 0;
    virtual bool seesNothing(std::span<const geometry::Plane>) const { return false; } ///< see transport::Integrator
    virtual void tally(transport::BounceTally*) {}                                     ///< see transport::Integrator
    /// See transport::Integrator.
    virtual bool unfinished() const { return false; }
};

struct Engine {
    std::function<std::shared_ptr<const transport::World>(std::shared_ptr<const scene::Frame>, const transport::Settings&,
                                                          Diagnostics&)>
        build;
    std::function<std::unique_ptr<Tracer>(std::shared_ptr<const transport::World>, Diagnostics&)> tracer;
};

/// The renderer's own engine: buildWorld() and Integrator.
Engine transportEngine();

} // namespace alpenglow::render

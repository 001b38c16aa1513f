// The light transport engine: a frame prepared for rendering (World), and the light along camera rays (Integrator). Under
// "hidden" and "raytrace" shaders keep their classic RenderMan semantics; under "path" all light reaches their lobes
// (docs/design/light-transport.md).
#pragma once
#include "base/diagnostics.h"
#include "geometry/plane.h"
#include "integrator/samples.h"
#include "scene/fwd.h"
#include "scene/primitive.h"
#include "world/world.h"
#include <memory>
#include <span>

namespace alpenglow::integrator {

/// World::build() with an Evaluator that runs kernels as the integrator does.
std::shared_ptr<const World> buildWorld(std::shared_ptr<const scene::Frame>, const Settings&, Diagnostics&);

class Integrator {
public:
    explicit Integrator(std::shared_ptr<const World>, Diagnostics&);
    ~Integrator();
    /// Traces all rays to the end. Results do not depend on which rays share a call. Returns false if `stop` was set; the results
    /// are then undefined. Use one Integrator per thread.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// Whether camera rays within all of these half-spaces are known to hit nothing and to be black, so that they need not be
    /// traced. Conservative: false means unknown. True mainly under hidden.
    bool seesNothing(std::span<const geometry::Plane>) const;
    /// Whether a ray of the last trace() reached the bound of a deferred procedural; its results are then undefined (deferred.h).
    bool unfinished() const;
    const Counters& counters() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace alpenglow::integrator

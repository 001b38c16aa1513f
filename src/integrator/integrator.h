// The light transport engine: one frame made ready (World), and what arrives along camera rays (Integrator). Under "hidden" and
// "raytrace" shaders keep their classic meaning; under "path" their lobes get all light (docs/design/light-transport.md).
#pragma once
#include "base/diagnostics.h"
#include "geometry/plane.h"
#include "integrator/samples.h"
#include "scene/fwd.h"
#include "scene/primitive.h"
#include "world/world.h"
#include <memory>
#include <span>

namespace alpenglow::transport {

/// World::build() with kernels that run as the integrator runs them.
std::shared_ptr<const World> buildWorld(std::shared_ptr<const scene::Frame>, const Settings&, Diagnostics&);

class Integrator {
public:
    explicit Integrator(std::shared_ptr<const World>, Diagnostics&);
    ~Integrator();
    /// Follows all rays to the end. Results do not depend on which rays share a call. False when `stop` was set meanwhile: then
    /// the results are void. One Integrator per thread.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// Camera rays that stay within all of these half-spaces are known to meet nothing, and to bring nothing: they need not be
    /// traced. Under hidden, as a rule; false says nothing.
    bool seesNothing(std::span<const geometry::Plane>) const;
    /// Whether a ray of the last trace() came to the bound of a procedural that is not made yet: its results are void (unmade.h).
    bool unfinished() const;
    const Counters& counters() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace alpenglow::transport

// Deep shadow maps: transmittance along each camera ray, behind every surface and within media (Lokovic and Veach, Deep Shadow
// Maps, 2000).
#pragma once
#include "integrator/context.h"

namespace alpenglow::integrator {

class Intersector;
class MediaStacks;
class Opacities;
struct StageSet;

/// Traces camera rays for their transmittance alone.
class DepthRays final : Stage {
public:
    explicit DepthRays(const StageSet&);
    /// Fills SampleResult::transmittance of camera rays. begin: makes the i-th path ray of the call. Returns false if stopped.
    bool seeThrough(std::span<const CameraRay>, std::span<SampleResult>,
                    const std::function<void(const CameraRay&, size_t, PathRay&)>& begin);

private:
    class Looking;
    Intersector& intersector_;
    MediaStacks& media_;
    Opacities& opacities_;
};

} // namespace alpenglow::integrator

// The beginning of photons: where they leave their lights, and with what power.
#pragma once
#include "integrator/photonjob.h"

namespace alpenglow::transport {

/// A photon before its first ray.
struct EmissionStart {
    EmissionDraw drawn;
    Vec3 origin, dir;               ///< dir: unit; zero: this draw brings nothing
    geometry::SurfacePoint surface; ///< Area
    const geometry::Shape* shape = nullptr;
    Color power{0};     ///< BoundLight::photons
    float pdf = 0;      ///< and what generatePhoton() says of it
    float factor = 0;   ///< of what the light's kernel says, before `length`
    float length = 0;   ///< of the way to what it meets first; 0: nothing
    float kept = 1;     ///< LightValue::kept() of rays of highlights, where the photon arrives first
    bool front = false; ///< Area: on the side of n
};

/// Fills what follows from `drawn`, for photons of one light.
void startPhotons(LightKernels&, const EmissionPlan&, const EmissionPlan::Light&, std::span<EmissionStart>);

/// The power of one photon that is emitted alone, by what the light's shader says where it arrives first. 0 where `length` is.
/// Fills `kept`.
std::vector<Color> emittedPower(LightKernels&, const EmissionPlan::Light&, std::span<EmissionStart>);

} // namespace alpenglow::transport

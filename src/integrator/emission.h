// The start of photons: where they leave lights, and with what power.
#pragma once
#include "integrator/photonjob.h"

namespace alpenglow::integrator {

/// A photon before its first ray.
struct EmissionStart {
    EmissionDraw drawn;                     ///< its random numbers
    Vec3 origin, dir;                       ///< dir: unit; zero: the sample carries no power
    geometry::SurfacePoint surface;         ///< Area
    const geometry::Shape* shape = nullptr; ///< Area: not null
    Color power{0};                         ///< from BoundLight::photons
    float pdf = 0;                          ///< density returned by its generatePhoton()
    float factor = 0;                       ///< multiplies the value of the light's kernel, before `length` applies
    float length = 0;                       ///< distance to the first hit; 0: no hit
    float kept = 1;                         ///< LightValue::kept() of rays of highlights, at the photon's first hit
    float keptDiffuse = 1;                  ///< the same of diffuse rays
    bool front = false;                     ///< Area: leaves on the side of n
};

/// Completes photons of one light from their `drawn`.
void startPhotons(LightKernels&, const EmissionPlan&, const EmissionPlan::Light&, std::span<EmissionStart>);

/// The power of each photon, from the light's shader at the photon's first hit, as if it were the only photon. 0 where `length`
/// is 0. Sets `kept`.
std::vector<Color> emittedPower(LightKernels&, const EmissionPlan::Light&, std::span<EmissionStart>);

} // namespace alpenglow::integrator

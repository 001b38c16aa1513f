// Irradiance records (world/records.h) while their rays are in flight.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::integrator {

/// A record while its rays are in flight.
struct Recording {
    LightRecord record;       ///< the record, as far as it is known
    std::array<Vec3, 3> axes; ///< of the hemisphere, camera space; the last one is its axis
    int rings = 1, turns = 1; ///< of the stratification: over the polar angle, over the azimuth
    /// `pixel`: width of a pixel there, camera space; `most`: largest radius of the record, in pixels; the others: "maxdist" and
    /// "bias" of the call.
    float pixel = 0, most = 0, reach = 1e38f, bias = -1;
    shading::Fade fade;                 ///< of the call
    Color tint{1};                      ///< of the environment map
    const RayKind* kind = nullptr;      ///< of its rays
    const TraceSite* site = nullptr;    ///< of the call
    bool blocks = false;                ///< of an occlusion()
    std::vector<PathRay> rays;          ///< to be sent
    std::vector<AccumulatorId> targets; ///< by ray, after sending
    std::vector<Color> seen;            ///< result, by ray
    std::vector<float> ways;            ///< distance of the hit, by ray
};

} // namespace alpenglow::integrator

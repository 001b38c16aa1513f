// Irradiance records (world/records.h) while their rays are in flight.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::integrator {

struct Recording {
    LightRecord record;
    std::array<Vec3, 3> axes;
    int rings = 1, turns = 1;
    float pixel = 0, most = 0, reach = 1e38f, bias = -1;
    shading::Fade fade;
    Color tint{1}; ///< of the environment map
    const RayKind* kind = nullptr;
    const TraceSite* site = nullptr;
    bool blocks = false;                ///< of an occlusion()
    std::vector<PathRay> rays;          ///< to be sent
    std::vector<AccumulatorId> targets; ///< by ray, after sending
    std::vector<Color> seen;            ///< result, by ray
    std::vector<float> ways;
};

} // namespace alpenglow::integrator

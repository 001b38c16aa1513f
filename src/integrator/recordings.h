// Records of hemispheres (world/records.h) while their rays are under way.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::transport {

struct Recording {
    LightRecord record;
    std::array<Vec3, 3> axes;
    int rings = 1, turns = 1;
    float pixel = 0, most = 0, reach = 1e38f, bias = -1;
    shading::Fade fade;
    Color tint{1}; ///< of the environment map
    const RayKind* kind = nullptr;
    const TraceSite* site = nullptr;
    bool blocks = false;           ///< of an occlusion()
    std::vector<PathRay> rays;     ///< not yet sent
    std::vector<TargetId> targets; ///< by ray, once sent
    std::vector<Color> seen;       ///< and what came of it
    std::vector<float> ways;
};

} // namespace alpenglow::transport

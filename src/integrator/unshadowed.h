// Light along a ray of trace() if only area lights existed: "unshadowedarealight" for rays without light samples, and
// "unshadowedenvironment", which area lights still occlude.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Intersector;
class LightKernels;
class LitSurfaces;
struct StageSet;

/// A ray of a trace() with sums, from a point of a batch. Current space.
struct UnshadowedRay {
    int point = 0;                 ///< index in the batch
    const RayKind* rays = nullptr; ///< never null
    Vec3 origin, direction;        ///< unit direction
    float maxDistance = 1e38f;     ///< of the call
    bool bringsEmission = false;   ///< its call samples lights, but not for this ray: a delta lobe, or a ray from elsewhere
    Vec3 lit;                      ///< the point that the lights see
    int litSurface = -1;           ///< index in LitSurfaces::values
};

/// Light that ignores occlusion, for trace().
class UnshadowedLight final : Stage {
public:
    explicit UnshadowedLight(const StageSet&);
    /// Adds the light that the ray would bring without occlusion. through: its throughput; environment: of its map.
    void add(const BatchContext&, const UnshadowedRay&, const Color& through, const Color& environment, TraceSums&);

private:
    Intersector& intersector_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
};

} // namespace alpenglow::integrator

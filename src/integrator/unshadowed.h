// Light along a ray of trace() without occlusion, for its results "unshadowedarealight" and "unshadowedenvironment".
#pragma once
#include "integrator/context.h"
#include "integrator/rays.h"

namespace alpenglow::integrator {

struct BatchContext;
class Intersector;
class LightKernels;
class LitSurfaces;
struct LobeVertex;
struct StageSet;

class UnshadowedLight final : Stage {
public:
    explicit UnshadowedLight(const StageSet&);
    /// Adds to the sums of a call what a ray of a request would find if only area lights existed; these still hide the
    /// environment. lamps: area lights count, as light samples do not estimate them. through: factor of the light; environment:
    /// radiance of the call's map in direction w, unit.
    void add(const BatchContext&, const LobeVertex&, bool lamps, const Vec3& origin, const Vec3& w, const Color& through,
             const Color& environment, TraceSums&);

private:
    Intersector& intersector_;
    LightKernels& lightKernels_;
    LitSurfaces& litSurfaces_;
};

} // namespace alpenglow::integrator

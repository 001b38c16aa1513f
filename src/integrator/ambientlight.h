// ambient() under path: what of the ambient lights reaches a point from the hemisphere that is seen, by a shadow ray a call.
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::transport {

class Accumulator;
class LightKernels;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class RayStore;
class ShadowRays;
struct StageSet;
class SurfacePoints;

class AmbientLight final : Stage {
public:
    explicit AmbientLight(const StageSet&);
    /// Makes shadow rays of the calls of a batch.
    void gather(BatchContext&);

    std::vector<AmbientAsked> asked; ///< of the batch whose requests are taken
    const bool lights;               ///< some light answers ambient()

private:
    void draw(const BatchContext&, std::vector<AmbientAsked>& calls);
    void send(const BatchContext&, const AmbientAsked&, const Color& light, int number, int& last);
    render::NumberRows numbers_;
    std::vector<int> litBy_; ///< RayExtra::lit of the queries of a light
    Accumulator& accumulator_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    RayStore& store_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::transport

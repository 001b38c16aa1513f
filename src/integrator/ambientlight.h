// ambient() under path: light of ambient lights that arrives from the visible part of the hemisphere. One shadow ray per call.
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"

namespace alpenglow::integrator {

class Accumulator;
class LightKernels;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class RayStore;
class ShadowRays;
struct StageSet;
class SurfacePoints;

/// Light of ambient lights for calls of ambient().
class AmbientLight final : Stage {
public:
    explicit AmbientLight(const StageSet&);
    /// Makes the shadow rays for the ambient() calls of a batch.
    void gather(BatchContext&);

    std::vector<AmbientAsked> asked; ///< calls of the batch whose requests are being processed
    const bool lights;               ///< at least one light contributes to ambient()

private:
    void draw(const BatchContext&, std::vector<AmbientAsked>& calls);
    void send(const BatchContext&, const AmbientAsked&, const Color& light, int number, int& last);
    NumberRows numbers_;
    std::vector<int> litBy_; ///< RayExtra::lit, by query of a light
    Accumulator& accumulator_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    RayStore& store_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

// Emission: light of emitters that rays hit and of skies that escaped rays reach, weighted by MIS against sampling these lights.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class GatherCalls;
class LightKernels;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class MediumEvents;
class PhotonStage;
class RayStore;
class ShadowRays;
struct StageSet;

/// Adds the light of emitters and skies that rays reach.
class EmittedLight final : Stage {
public:
    explicit EmittedLight(const StageSet&);
    /// Adds light of the emitters among the points of a batch.
    void hits(const BatchContext&, Sched&);
    /// Adds light of skies to rays that left the scene.
    void misses(std::span<const Sched::Task* const>, Sched&);

private:
    struct Met {
        int light;
        AccumulatorId target;
        const ShadePoint* point;
    };
    void emission(std::span<const Met>, Sched&); ///< sorted by light
    /// Transmittance of surfaces that only shadow rays see, along the path to light that shadow rays find too.
    Color differentShadow(const PathRay&, float distance);
    float mixedPdf(const PathRay&, const BoundLight&, float pdf, const Vec3& w) const;
    std::vector<int> litBy_; ///< RayExtra::lit, by query of a light
    Accumulator& accumulator_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    MediumEvents& mediumEvents_;
    PhotonStage& photons_;
    RayStore& store_;
    ShadowRays& shadows_;
    const GatherCalls& gathers_;
};

} // namespace alpenglow::integrator

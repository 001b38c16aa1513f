// Where a path ends by its depth limit: shadow rays to the skies that only rays of lobes would reach. At that vertex lamps are
// still sampled; a sky that is not sampled as a light must count as well, so the ray that would have reached it becomes a shadow
// ray with the light of the sky alone.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/lightpathstates.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

class LightKernels;
class LitSurfaces;
class MediaStacks;
class ShadowRays;

/// A sampled direction of a lobe whose ray the depth limit ends.
struct LastRay {
    int point;                 ///< index in the batch
    const RayKind* kind;       ///< of the ray that is not sent
    Vec3 origin, direction;    ///< unit direction
    Color weight;              ///< of the light that it would find, at its target
    AccumulatorId target;      ///< receives the light
    float maxDistance = 1e38f; ///< the sky counts if nothing is nearer
    int lit = -1;              ///< index in LitSurfaces::values
    int32_t share = -1;        ///< RayExtra::share
    uint16_t path = 0;         ///< PathRay::path of the ray
};

/// Queues shadow rays to skies that lobes alone reach.
class LastSkies final : Stage {
public:
    explicit LastSkies(const StageSet&);
    /// Whether the scene has skies that only rays reach.
    bool any() const { return !skies_.empty(); }
    /// Queues shadow rays to these skies for rays from points of the batch.
    void send(const BatchContext&, std::span<const LastRay>);

private:
    void send(const BatchContext&, std::span<const LastRay>, int light);
    std::vector<int> skies_; ///< numbers of these lights
    Accumulator& accumulator_;
    LightKernels& lightKernels_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::integrator

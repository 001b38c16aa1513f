// Light of the photons of a pass that paths gather, and lobes that photons treat as mirrors. Reads VertexBlocks::sites; writes
// LobeBlock::narrow and left, and light to the accumulator.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"
#include "photonmap/photongrid.h"

namespace alpenglow::integrator {

class Accumulator;
class GuideRays;
class PhotonStage;

/// Adds light of photons at vertices.
class PhotonGather final : VertexStage {
public:
    PhotonGather(const StageSet&, const VertexStages&);
    /// After prepare(): finds the points that gather photons, and sets LobeBlock::narrow and left.
    void mark(BatchContext&);
    /// Points whose lobe must not sample a light, because photons carry its light to them.
    Lanes bring(const LobeBlock&, const BoundLight&) const;
    /// After select(): adds the light of nearby photons to the lobes that receive light from all directions.
    void take(BatchContext&, Sched&);
    /// Sets the trail of the next rays of a block.
    void keep(size_t block, const BatchContext&);
    /// Whether photons treat a lobe as a mirror although it is no delta lobe. below: lobes with a smaller
    /// spread, in radians, are.
    bool isNarrow(const Site&, size_t point, float below, BatchContext&) const;
    /// Whether photons continue along a lobe as along a mirror, once LobeBlock::narrow is set.
    bool mirrors(const Site&, size_t point, const BatchContext&) const;

private:
    struct Near {
        Vec3 from;
        Color light; ///< radiance times steradians
    };
    bool seesAll(const Site&, size_t point, const BatchContext&) const;
    bool spreads(const Site&, size_t point, const BatchContext&) const;
    uint8_t trailBehind(const Site&, size_t point, const BatchContext&) const;
    void findNear(const photonmap::PhotonGrid&, size_t point, const BatchContext&);
    Color givenBack(const Site&, size_t point) const;
    Accumulator& accumulator_;
    GuideRays& guide_;
    const LightPathStates& paths_;
    PhotonStage& stage_;
    SurfacePoints& surfaces_;
    std::vector<Lanes> gathers_; ///< by block: points that gather photons; empty: none does
    std::vector<Near> near_;     ///< photons near a point
};

} // namespace alpenglow::integrator

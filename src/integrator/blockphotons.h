// Photons for vertices in blocks of 16 (blockvertices.h): light of the photons of a pass that paths gather.
#pragma once
#include "integrator/blockvertices.h"
#include "photonmap/photongrid.h"

namespace alpenglow::integrator {

class BlockVertices::Photons {
public:
    Photons(BlockVertices&, const StageSet&);
    /// After prepare(): finds the points that gather photons, and sets LobeBlock::narrow and left.
    void mark(BatchContext&);
    /// Points whose lobe must not sample a light, because photons carry its light to them.
    Lanes bring(const LobeBlock&, const BoundLight&) const;
    /// After select(): adds the light of nearby photons to the lobes that receive light from all directions.
    void take(BatchContext&, Sched&);
    /// Sets the trail of the next rays of a block.
    void keep(size_t block, const BatchContext&);
    /// Whether photons treat a lobe as a mirror although it is no delta lobe. below: PhotonStage::narrowBelow().
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
    BlockVertices& b_;
    GuideRays& guide_;
    PhotonStage& stage_;
    std::vector<Lanes> gathers_; ///< by block: points that gather photons; empty: none does
    std::vector<Near> near_;     ///< photons near a point
};

} // namespace alpenglow::integrator

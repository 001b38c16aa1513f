// Picks the lobe of each point that its path follows (or all lobes, under the other hiders), samples its direction, plays
// roulette, and makes the next rays. Reads VertexBlocks::sites and vertices; writes VertexBlocks::next, then rays, which it hands
// to the scheduler.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

class Accumulator;
class MediaStacks;
class SubsurfaceWalks;

/// Makes the next rays of paths.
class ScatterRays final : VertexStage {
public:
    ScatterRays(const StageSet&, const VertexStages&);
    /// For all blocks of the batch; the rays go to the scheduler.
    void run(BatchContext&, Sched&);
    /// For the lobes that VertexBlocks::next names in a block: samples their directions and evaluates them there.
    void drawDirections(size_t block);
    /// Draws roulette numbers and names the next vertices.
    void throwDice(size_t block);
    /// Turns rays of subsurface() into walks (SubsurfaceWalks::walks).
    void walkBelow(size_t block, BatchContext&);
    /// Fills the next rays from VertexBlocks::next.
    void makeRays(size_t block, BatchContext&);
    /// Hands the rays of VertexBlocks::next to the scheduler.
    void spawn(const RayBlock&, Sched&);
    /// Roulette is played whatever the rules: photons.
    void playsRoulette();

private:
    void scatterAll(size_t block, BatchContext&, Sched&);
    void endTrees(size_t block);
    void endByChance(size_t block);
    void sendRays(size_t block, BatchContext&, Sched&);
    void turnRays(size_t block, BatchContext&);
    void applyOptions(size_t block, const BatchContext&);
    void keepLobes(size_t block, BatchContext&);
    std::vector<uint32_t> keys_; ///< by site, its number
    Roulette roulette_ = Roulette::None;
    bool endsTrees_ = false; ///< lights send rays: roulette goes by throughput alone
    Accumulator& accumulator_;
    GuideScatter& guided_;
    PhotonFlight& flight_;
    PhotonGather& gathered_;
    SingleRequests& single_;
    MediaStacks& media_;
    RayStore& store_;
    SubsurfaceWalks& subsurface_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

// Albedo of each lobe, the energy rule, and the probability of following its ray (docs/design/light-transport.md); light-directed
// sampling in media. Reads VertexBlocks::sites and vertices; writes LobeBlock::chosen, lights, ended, failed,
// VertexBlock::energyScale and passes, BlockLobes::lightDirected.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"
#include <set>

namespace alpenglow::integrator {

class Accumulator;
class MediumEvents;

/// Decides which lobes are followed, and how likely.
class LobeSelection final : VertexStage {
public:
    LobeSelection(const StageSet&, const VertexStages&);
    /// Computes what lobes need for queries, and which ones sample lights.
    void prepare();
    /// Computes the probabilities of following the rays of the lobes.
    void select(const BatchContext&);
    /// Adds to the output "albedo" (albedo.cpp).
    void showAlbedo(BatchContext&);
    /// Selects lights for light-directed sampling, and the lobes that use it (lightdirections.cpp).
    void lightDirections(const BatchContext&);
    /// Warns once per shader that its indirect light is scaled down. more: its reflectance alone exceeds 1.
    void reportScaled(const SurfaceBinding&, bool more);

private:
    /// Shaders already reported: reflectance over 1; reflectance plus transparency over 1.
    std::set<const void*> tamed_, tamedClear_;
    Accumulator& accumulator_;
    PhotonFlight& flight_;
    MediumEvents& mediumEvents_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

// Skies at the last vertices of paths: samples the lobes whose rays a depth limit ends, and sends shadow rays to skies that only
// these rays would have reached (lastskies.h). Reads LobeBlock::ended; writes ShadowRays::queue.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

/// Samples the lobes of a block that a depth limit ends.
class LastVertices final : VertexStage {
public:
    LastVertices(const StageSet&, const VertexStages&);
    /// For all blocks of the batch.
    void run(BatchContext&);

private:
    void endLobe(const Site&, size_t block, const BatchContext&);
    std::vector<LastRay> ends_;
    LastSkies& lastSkies_;
    SingleRequests& single_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

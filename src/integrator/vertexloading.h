// First stage over vertices: from a batch's structures to columns. Reads points (or surfaces), rays, transparency; writes
// VertexBlocks::vertices and rays.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

/// Fills the columns of a batch.
class VertexLoading final : VertexStage {
public:
    VertexLoading(const StageSet&, const VertexStages&);
    /// Forgets the last batch. waits: its kernel waits for its results.
    void begin(const BatchContext&, bool waits);
    /// Returns false if the shader moved points: then requests must be made one by one (VertexBlocks::single).
    bool loadVertices(const BatchContext&);

private:
    void takeRays(const RayBlock&, bool between);
    void endRays(size_t block, int lane, const SurfaceBinding&, bool between);
    void loadPoints(size_t block, const BatchContext&);
    void loadFlown(size_t block, const BatchContext&);
    GuideScatter& guided_;
};

} // namespace alpenglow::integrator

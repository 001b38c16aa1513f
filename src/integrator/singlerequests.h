// Requests that were made one by one (Requests::lobes): of calls whose arguments LobeRequests cannot read in rows. Their lobes
// become rows of VertexBlocks::sites; what only such calls have stays in LobeVertex, which BlockLobes::requests names by point.
#pragma once
#include "integrator/requests.h"
#include "integrator/unshadowed.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

/// Reads requested lobes one by one.
class SingleRequests final : VertexStage {
public:
    SingleRequests(const StageSet&, const VertexStages&);
    /// Fills the blocks with a batch's points and its requests, which it removes.
    void load(BatchContext&);
    /// Draws directions again at points where a lobe had none, for calls that return a mean over directions. Sets
    /// VertexBlocks::idle.
    void drawAgain(const Site&, size_t block, Lanes);
    /// Before the rays of a block are sent: removes those that carry only emission and miss all emitters, and adds the light that
    /// they would see without occlusion to the sums of their calls.
    void examine(size_t block, BatchContext&);
    /// Sets what only rays of such requests carry.
    void addToRay(const LobeVertex&, RayExtra&, int lane, const BatchContext&);

private:
    void take(BatchContext&);
    size_t siteOf(const LobeVertex&, size_t next, const BatchContext&);
    void takeRequest(Site&, const LobeVertex&);
    void readOptions(Site&);
    bool intersectsEmitter(const LobeVertex&, size_t point, const Vec3& w) const;
    Color throughputOf(int lane) const;
    std::vector<LobeVertex> lobes_; ///< taken from Requests::lobes
    LobeLanesList lanes_;
    UnshadowedLight unshadowed_;
    Accumulator& accumulator_;
    VertexLoading& loading_;
    Requests& requests_;
};

} // namespace alpenglow::integrator

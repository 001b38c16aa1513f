// Requests that were made point by point (Requests::lobes), for vertices in blocks (blockvertices.h): calls whose arguments stage
// `request` cannot read in rows. Their lobes become rows; what only such calls have stays in LobeVertex.
#pragma once
#include "integrator/blockvertices.h"
#include "integrator/requests.h"
#include "integrator/unshadowed.h"

namespace alpenglow::integrator {

class BlockVertices::Requested {
public:
    Requested(BlockVertices&, const StageSet&);
    /// BlockVertices::runRequests().
    void run(BatchContext&, Sched&);
    /// Fills the blocks with a batch's points and its requests, which it removes.
    void load(BatchContext&);
    /// The batch has none.
    void clear() { lobes_.clear(); }
    bool empty() const { return lobes_.empty(); }
    /// Draws directions again at points where a lobe had none, for calls that return a mean over directions. Sets idle_.
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
    BlockVertices& b_;
    const WorldImpl& world_;
    Requests& requests_;
    UnshadowedLight unshadowed_;
    std::vector<LobeVertex> lobes_; ///< taken from Requests::lobes
};

} // namespace alpenglow::integrator

// Reads the requests of a kernel in rows: from arguments of calls (BatchContext::emits) to lobes, call site by call site. Writes
// VertexBlocks::sites. Calls whose arguments this stage cannot read are left to SingleRequests.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/vertexblocks.h"

namespace alpenglow::integrator {

class OcclusionCalls;
class PhotonStage;

/// Reads requested lobes in rows.
class LobeRequests final : VertexStage {
public:
    LobeRequests(const StageSet&, const VertexStages&);
    /// Reads all requests of a batch. Returns false, with no effect that counts, if they must be read one by one: points differ
    /// in the order of their calls, or numbers are not usual.
    bool read(BatchContext&);

private:
    class CallCount;
    bool findSites(const BatchContext&);
    void beginSite(Site&, int number, const BatchContext&);
    bool request(BatchContext&);
    void noteHemispheres(const Site&, BatchContext&);
    bool requestOf(Site&, const EmitRecord&, const BatchContext&);
    void countCalls(Site&, const EmitRecord&, const BatchContext&, std::vector<uint32_t>& before);
    bool readOptions(Site&, BatchContext&);
    LobeLanesList lanes_;
    OcclusionCalls& occlusion_;
    PhotonStage& photons_;
    RayStore& store_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

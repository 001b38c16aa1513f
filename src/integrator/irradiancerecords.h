// Records of hemispheres (world/records.h): read where a call asks, found by rays of their own where they are missing.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/recordings.h"

namespace alpenglow::transport {

class Intersector;
class MediaStacks;
class OcclusionCalls;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;

class IrradianceRecords final : Stage {
public:
    explicit IrradianceRecords(const StageSet&);
    /// What records say of the hemisphere that a call asks for at a point of a batch. Nothing: it is to be found exactly. In a
    /// pass that finds records one may be begun there; then it is anything. `kind`: of the call's rays.
    std::optional<Color> recorded(const BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                  const RayKind* kind, uint32_t occurrence);
    void follow(Sched&);     ///< sends the rays of those that were begun
    void keep(const Sched&); ///< once all rays are followed
    void forget();

private:
    void sendRecord(const BatchContext&, int point, uint32_t call, uint32_t occurrence, Recording&);
    void blockedRecord(Recording&);
    std::vector<Recording> recordings_;
    size_t recordsSent_ = 0;
    Intersector& intersector_;
    MediaStacks& media_;
    OcclusionCalls& occlusion_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
};

} // namespace alpenglow::transport

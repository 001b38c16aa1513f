// Irradiance caching (world/records.h): calls interpolate records; in the pass that makes records, rays of their own compute
// them.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/recordings.h"

namespace alpenglow::integrator {

class Intersector;
class MediaStacks;
class OcclusionCalls;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;

/// Answers calls of occlusion() and indirectdiffuse() from irradiance records, and makes these.
class IrradianceRecords final : Stage {
public:
    explicit IrradianceRecords(const StageSet&);
    /// The interpolated value of a hemisphere call at a point of a batch. Without a value the hemisphere must be sampled. In the
    /// pass that makes records a new record may start here; the value is then arbitrary. `kind`: of the call's rays.
    std::optional<Color> recorded(const BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                  const RayKind* kind, uint32_t occurrence);
    void follow(Sched&);     ///< sends the rays of new records
    void keep(const Sched&); ///< stores the records after all rays are traced
    /// Drops the records whose rays are in flight.
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

} // namespace alpenglow::integrator

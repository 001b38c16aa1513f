// The rays of gather statements. A kernel that asks for a handful waits only where shaders must run at what they met; what the
// rays, the primitives and their attributes say is known at once.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "world/gathersite.h"

namespace alpenglow::transport {

class KernelInputs;
struct StageSet;

/// A ray of a gather whose hit must be shaded, and where that goes.
struct GatherSent {
    PathRay ray;
    float* row = nullptr; ///< of GatherRows
    const geometry::Shape* met = nullptr;
    const GatherSite* site = nullptr;
    bool quiet = false;        ///< its light and opacity are told already
    bool told = false;         ///< the shaders at the hit have run
    std::vector<float> values; ///< of GatherSite::sent, one after the other
};

class GatherCalls final : Stage {
public:
    explicit GatherCalls(const StageSet&);
    /// Makes the rays of one request of a gather and finds what they meet; those whose hits must be shaded go to `sent`. `in`:
    /// rows of arguments; `occurrence`, `asked`: by lane, how often the statement ran there before, and the rays that the kernel
    /// has asked for. The rows are the batch's until the strip ends.
    GatherRows& cast(BatchContext&, const SiteInfo&, int first, uint64_t mask, int lanes, const float* in,
                     std::span<const uint32_t> occurrence, std::span<uint32_t> asked, std::vector<GatherSent>& sent);
    /// Parameters at points that rays of gathers have met, as these have sent them.
    void takeSent(BatchContext&) const;
    /// What the shaders at a hit give to the gather whose ray met it; `point` of a batch that has run.
    void tellGather(const BatchContext&, int point, GatherSent&);

    std::unordered_map<TargetId, GatherSent*> gathered; ///< rays of gathers that ask shaders, by target

private:
    const StageSet& set_;
    KernelInputs& inputs_;
};

} // namespace alpenglow::transport

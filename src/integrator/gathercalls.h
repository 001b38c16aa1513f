// Rays of gather() statements. A kernel waits only if its outputs need shaders at the hits; values of the rays, the primitives
// and their attributes are available at once.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "world/gathersite.h"

namespace alpenglow::integrator {

class KernelInputs;
struct StageSet;

/// A ray of a gather() whose hit must be shaded, and where the result goes.
struct GatherSent {
    PathRay ray;
    float* row = nullptr;                 ///< in GatherRows
    const geometry::Shape* met = nullptr; ///< what the ray hit; null: nothing
    const GatherSite* site = nullptr;     ///< of its statement
    bool quiet = false;                   ///< light and opacity are in the row already
    bool shaded = false;                  ///< the shaders at the hit have run
    /// Values of GatherSite::sent, one behind the other.
    std::vector<float> values;
    /// By entry of GatherSite::sent, where its values end.
    std::vector<size_t> ends;
    /// The value of an entry of GatherSite::sent.
    shading::GivenValue value(size_t sent) const;
};

/// Answers gather().
class GatherCalls final : Stage {
public:
    explicit GatherCalls(const StageSet&);
    /// Makes the rays of one gather() request and intersects them; rays whose hits need shading are appended to `sent`. `in`:
    /// argument rows. `occurrence`, by lane: how often the statement ran there before. `asked`, by lane: rays that the kernel has
    /// requested. The batch owns the rows until the strip ends.
    GatherRows& cast(BatchContext&, const SiteInfo&, int first, uint64_t mask, int lanes, const float* in,
                     std::span<const uint32_t> occurrence, std::span<uint32_t> asked, std::vector<GatherSent>& sent);
    /// Sets parameters of shaders of that kind at hits of gather() rays to the values that the rays send. `targets`: by point of
    /// the batch.
    void takeSent(shading::Batch&, std::span<const AccumulatorId> targets, rsl::PairName::To) const;
    /// The ray of a gather() that sends something to shaders of that kind; null: none.
    const GatherSent* sending(AccumulatorId, rsl::PairName::To) const;
    /// The parameters of a light that the ray meets, with the numbers that it sends; false: it sends none to this light.
    static bool lightParameters(const GatherSent&, const ShaderInstance& light, shading::ParameterBlock&);
    /// Writes the shader results at a hit to the gather() whose ray found it; `point`: in a batch that has run.
    void answerGather(const BatchContext&, int point, GatherSent&);

    std::unordered_map<AccumulatorId, GatherSent*> gathered; ///< rays of gathers that need shaders, by target

private:
    const StageSet& set_;
    KernelInputs& inputs_;
};

} // namespace alpenglow::integrator

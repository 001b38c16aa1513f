// Accumulate: light that reaches targets, and what it is shared with. The only way that light is added; sums are exact, so that
// order does not matter. Values that are not finite numbers spoil their camera sample.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

struct SampleResult;
class LightPathStates;
struct StageSet;

class Accumulator final : Stage {
public:
    explicit Accumulator(const StageSet&);
    void begin(size_t samples); ///< of a call: targets and shares of the one before are gone
    /// Adds light to a target, and its parts to the outputs that share it.
    void deposit(Sched&, const Deposit&);
    /// The parts of what a volume shader shows, by light path: what the surface gives by itself, `met` of it, and what the volume
    /// adds.
    void depositThroughVolume(Sched&, const PathRay&, const Color& met, const Color& shown);
    /// A value on the way of a ray is not a finite number: the whole camera sample is left out. `what` made it, at `place`: said
    /// once.
    void notFinite(const PathRay*, const std::string& what, const SourcePlace& place);
    void notFinite(const PathRay* ray, const char* what, const ShaderInstance* of);
    void notFinite(const BatchContext&, const PathRay&, uint32_t site); ///< what a call site gives
    /// Sums of a target, where its trace() asks for them; else null.
    TraceSums* sumsOf(TargetId t) {
        if (traceSums.empty()) return nullptr;
        auto i = traceSums.find(t);
        return i == traceSums.end() ? nullptr : &i->second;
    }

    std::unordered_map<TargetId, TraceSums> traceSums;
    std::vector<Share> shares;
    std::vector<SampleResult*> results;    ///< by camera sample
    std::vector<TargetId> lightTargets;    ///< by camera sample, WorldImpl::lightOutputs_
    std::vector<TargetId> partTargets;     ///< by camera sample and part of the outputs by light path
    TargetId nowhere = shading::kNoTarget; ///< nobody reads it
    std::vector<int> spoiled;              ///< PathSample::path of samples that notFinite() has seen; some twice

private:
    void depositPart(Sched&, const PathRay*, uint16_t end, const Color& light);
    const LightPathStates& paths_;
};

} // namespace alpenglow::transport

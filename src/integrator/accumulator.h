// Accumulation: the only place where light is added to targets and to the outputs that share it. Sums are exact, so their order
// does not matter. A value that is not finite invalidates its camera sample.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

struct SampleResult;
class LightPathStates;
struct StageSet;

/// Adds light to targets.
class Accumulator final : Stage {
public:
    explicit Accumulator(const StageSet&);
    void begin(size_t samples); ///< Starts a call with so many camera samples; drops the targets and shares of the call before.
    /// Adds light to a target, and the corresponding parts to the outputs that share it.
    void contribute(Sched&, const Contribution&);
    /// Splits light that passed a volume shader by light path. met: light from the surface behind the volume; shown: what the
    /// volume makes of it. The difference is the volume's own contribution.
    void contributeThroughVolume(Sched&, const PathRay&, const Color& met, const Color& shown);
    /// Discards the camera sample of a ray that carries a value that is not finite. `what` made the value, at `place`; each place
    /// is reported once.
    void notFinite(const PathRay*, const std::string& what, const SourcePlace& place);
    /// Reports such a value once, with the shader that made it and the sample that repeats it; the sample is dropped.
    void notFinite(const PathRay* ray, const char* what, const ShaderInstance* of);
    void notFinite(const BatchContext&, const PathRay&, uint32_t site); ///< The value came from this call site
    /// Sums of a target whose trace() asks for them (TraceSums); else null.
    TraceSums* sumsOf(AccumulatorId t) {
        if (traceSums.empty()) return nullptr;
        auto i = traceSums.find(t);
        return i == traceSums.end() ? nullptr : &i->second;
    }

    std::unordered_map<AccumulatorId, TraceSums> traceSums; ///< of targets of a trace() that asks for sums
    std::vector<AovSplit> aovSplits;                        ///< parts of light for outputs; RayExtra::share is an index in it
    std::vector<SampleResult*> results;                     ///< by camera sample
    std::vector<AccumulatorId> lightTargets;                ///< by camera sample: WorldImpl::lightOutputs_
    std::vector<AccumulatorId> partTargets;                 ///< by camera sample and part of the light path outputs
    AccumulatorId nowhere = shading::kNoAccumulator;        ///< a target that no one reads
    std::vector<int> invalidSamples;                        ///< PathSample::path of samples to discard; may hold duplicates

private:
    void contributePart(Sched&, const PathRay*, uint16_t end, const Color& light);
    const LightPathStates& paths_;
};

} // namespace alpenglow::integrator

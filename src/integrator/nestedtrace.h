// Traces the rays of light kernels that wait for results: to the end at once, by a pipeline of its own. Lights that these rays
// reach may trace as well, one bounce deeper.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class SegmentEvents;
class MediumEvents;
class Pipeline;
struct GatherSent;
struct StageSet;

/// Traces rays of kernels of lights at once.
class NestedTrace final : Stage {
public:
    explicit NestedTrace(const StageSet&);
    ~NestedTrace();
    /// Result of a trace() at a lit point.
    shading::TargetValue trace(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                               uint32_t occurrence);
    /// Traces gather() rays and writes the results to their rows.
    void gather(std::span<GatherSent>);
    void forget(); ///< drops the pipeline and its pending work

private:
    const StageSet& begin();
    void takeCounts();
    shading::TargetValue follow(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                uint32_t occurrence);
    std::unique_ptr<Pipeline> inner_;
    const MediumEvents& mediumEvents_;
    Accumulator& accumulator_;
    SegmentEvents& segmentEvents_;
};

} // namespace alpenglow::integrator

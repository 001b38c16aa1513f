// Rays of lights' kernels that wait for what comes back: followed to the end at once, by a pipeline of their own. The lights that
// these rays meet may trace as well, one bounce deeper.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class Flights;
class MediumFlights;
class Pipeline;
struct GatherSent;
struct StageSet;

class NestedTrace final : Stage {
public:
    explicit NestedTrace(const StageSet&);
    ~NestedTrace();
    /// What a trace() gives at a point that the light lights.
    shading::TargetValue trace(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                               uint32_t occurrence);
    /// What rays of a gather bring, which go to their rows.
    void gather(std::span<GatherSent>);
    void forget(); ///< the pipeline, and what waits in it

private:
    const StageSet& begin();
    void takeCounts();
    shading::TargetValue follow(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row,
                                uint32_t occurrence);
    std::unique_ptr<Pipeline> inner_;
    const MediumFlights& mediumFlights_;
    Accumulator& accumulator_;
    Flights& flights_;
};

} // namespace alpenglow::transport

// Displacement at hits: P, N and the displacement outputs that the surface shader reads.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class GatherCalls;
class KernelInputs;
struct StageSet;

/// Runs displacement shaders of batches.
class Displacement final : Stage {
public:
    explicit Displacement(const StageSet&);
    /// Displaces the points of a batch by their displacement shader.
    void take(BatchContext&);
    /// Runs the displacement shader at the points of a batch (all of one binding). Returns null if it waits for rays.
    std::shared_ptr<BatchContext> displace(const BatchContext&);
    /// After displacement: moves the points to the facets of the diced surface, because rays hit the facets and start there.
    static void moveToFacets(BatchContext&);

private:
    KernelInputs& inputs_;
    const GatherCalls& gathers_;
};

} // namespace alpenglow::integrator

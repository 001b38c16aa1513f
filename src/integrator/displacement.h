// Displacement again at hits, for P, N and what the surface's shader asks of it.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class KernelInputs;
struct StageSet;

class Displacement final : Stage {
public:
    explicit Displacement(const StageSet&);
    /// Moves the points of a batch as their displacement shader says.
    void take(BatchContext&);
    /// Runs the displacement shader at the points of a batch (all of one binding); null where it waits for rays.
    std::shared_ptr<BatchContext> displace(const BatchContext&);
    /// Points of surfaces whose shaders move P, once the kernel has its inputs: rays met, and will leave, the facets.
    static void moveToFacets(BatchContext&);

private:
    KernelInputs& inputs_;
};

} // namespace alpenglow::transport

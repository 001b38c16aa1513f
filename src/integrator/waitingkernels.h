// Kernels that wait for rays: starts their strips, makes their requests together, and resumes them when the rays are done
// (strips.h).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class BatchPool;
class VertexLight;
class GatherCalls;
class KernelStrip;
class Requests;
class ShadowRays;
struct StageSet;
class SurfaceShading;

/// Runs kernels that are coroutines.
class WaitingKernels final : Stage {
public:
    explicit WaitingKernels(const StageSet&);
    /// Starts the strips of a kernel that waits for rays.
    void start(const std::shared_ptr<BatchContext>&, Sched&);
    /// Processes the requests of strips since the last call, those of a batch together.
    void follow(Sched&);
    /// Number of points of a waiting kernel that may be shaded now, so that its frames stay within a quarter of the limit; at
    /// least one strip. `other`: the same shader for points of several surfaces, or null; which of the two will run is not yet
    /// known.
    int roomFor(const rsl::CompiledKernel&, const rsl::CompiledKernel* other, const Sched&) const;

    // Called by strips.
    Accumulator& accumulator;
    GatherCalls& gathers;
    Requests& requests;
    ShadowRays& shadows;
    SurfaceShading& shading;
    /// Returns a finished strip's memory and batch to their pools.
    StripMemory takeMemory();
    /// For the next strip.
    void giveBack(StripMemory, std::shared_ptr<BatchContext>);
    std::vector<KernelStrip*> waiting; ///< with unprocessed requests
    /// A path had so many bounces.
    void sawDepth(int bounces) { counters_.depthMax = std::max(counters_.depthMax, bounces); }

private:
    std::vector<StripMemory> memory_; ///< of finished strips
    BatchPool& batches_;
    VertexLight& vertexLight_;
    std::unordered_map<const rsl::CompiledKernel*, size_t> frameOf_; ///< bytes of a strip's frame, by kernel
};

} // namespace alpenglow::integrator

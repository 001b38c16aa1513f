// Kernels that wait: strips are started, ask together, and go on when their rays are back (strips.h).
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class BatchPool;
class BlockVertices;
class GatherCalls;
class KernelStrip;
class Requests;
class ShadowRays;
struct StageSet;
class SurfaceShading;
class VertexLight;

class WaitingKernels final : Stage {
public:
    explicit WaitingKernels(const StageSet&);
    /// Starts the strips of a kernel that waits for rays.
    void start(const std::shared_ptr<BatchContext>&, Sched&);
    /// Follows what strips have asked for since the last call: those of a batch together.
    void follow(Sched&);
    /// Points of a waiting kernel that may be shaded now, so that its frames stay within a quarter of the limit; at least one
    /// strip. `other`: the same shader for points of several surfaces, or null; which of the two runs is not known yet.
    int roomFor(const rsl::CompiledKernel&, const rsl::CompiledKernel* other, const Sched&) const;

    // What strips call.
    Accumulator& accumulator;
    GatherCalls& gathers;
    Requests& requests;
    ShadowRays& shadows;
    SurfaceShading& shading;
    /// What a strip keeps, and its batch once it is done: used again.
    StripMemory takeMemory();
    void giveBack(StripMemory, std::shared_ptr<BatchContext>);
    std::vector<KernelStrip*> waiting; ///< whose requests nobody has followed yet
    void sawDepth(int bounces) { counters_.depthMax = std::max(counters_.depthMax, bounces); }

private:
    std::vector<StripMemory> memory_; ///< of strips that are done
    BatchPool& batches_;
    BlockVertices& blocks_;
    std::unordered_map<const rsl::CompiledKernel*, size_t> frameOf_; ///< bytes of a strip's frame, of kernels that were started
    VertexLight& vertexLight_;
};

} // namespace alpenglow::transport

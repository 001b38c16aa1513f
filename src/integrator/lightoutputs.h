// Outputs that displays ask for and that light reaches: kernels of their own at the camera's points, whose pairs share the lobes
// of Ci where they ask for the same light (lightoutputs.cpp).
#pragma once
#include "integrator/requests.h"

namespace alpenglow::transport {

class BatchPool;
class Displacement;
class KernelInputs;
class VertexLight;
class WaitingKernels;

/// A pair of an output that shares no lobe of Ci, or not in all components.
struct AskedAside {
    BatchContext* run;
    int record, lane;
    Color weight;
};

class LightOutputs final : Stage {
public:
    explicit LightOutputs(const StageSet&);
    /// For the camera's points of a batch that is filled: runs for the outputs that light reaches.
    std::vector<std::shared_ptr<BatchContext>> asides(const BatchContext&, Sched&);
    /// Gives the lobes of a batch their shares; what is left is returned. The asides have run.
    std::vector<AskedAside> shareLight(const BatchContext&, std::span<const AskedLobe>,
                                       std::span<const std::shared_ptr<BatchContext>>, Sched&);
    /// What shares nothing, and the outputs whose kernels wait for rays.
    void followAsides(std::span<const AskedAside>, std::span<std::shared_ptr<BatchContext>>, Sched&);
    /// Adds the outputs of points that are done.
    void finishAside(BatchContext&, int first, int lanes, Sched&);

private:
    Accumulator& accumulator_;
    BatchPool& batches_;
    Displacement& displacement_;
    KernelInputs& inputs_;
    Requests& requests_;
    ShadowRays& shadows_;
    VertexLight& vertexLight_;
    WaitingKernels& waitingKernels_;
};

} // namespace alpenglow::transport

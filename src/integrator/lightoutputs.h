// Output variables that receive light: separate kernels at camera points, whose pairs share the lobes of Ci if they request the
// same light (lightoutputs.cpp).
#pragma once
#include "integrator/requests.h"

namespace alpenglow::integrator {

class BatchPool;
class Displacement;
class KernelInputs;
class VertexLight;
class WaitingKernels;

/// A pair of an output that shares no lobe with Ci, or not in all components.
struct LightOutputRequest {
    BatchContext* run; ///< the batch of the camera points
    int record, lane;  ///< EmitRecord of the pair, and its lane
    Color weight;      ///< of the request
};

/// Runs the kernels of outputs that receive light.
class LightOutputs final : Stage {
public:
    explicit LightOutputs(const StageSet&);
    /// Batches that run the light outputs for the camera points of a filled batch.
    std::vector<std::shared_ptr<BatchContext>> lightOutputBatches(const BatchContext&, Sched&);
    /// Assigns outputs to the lobes of a batch and returns the pairs that share none. The output batches must have run.
    std::vector<LightOutputRequest> shareLight(const BatchContext&, std::span<const AskedLobe>,
                                               std::span<const std::shared_ptr<BatchContext>>, Sched&);
    /// Follows pairs that share no lobe, and outputs whose kernels wait for rays.
    void followLightOutputs(std::span<const LightOutputRequest>, std::span<std::shared_ptr<BatchContext>>, Sched&);
    /// Adds the outputs of completed points.
    void finishLightOutputs(BatchContext&, int first, int lanes, Sched&);

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

} // namespace alpenglow::integrator

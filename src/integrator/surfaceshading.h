// Surface shading: runs the surface kernel over a batch of points and the atmosphere, interprets the pairs as requests, adds the
// surface's own light, and continues rays behind transparent surfaces. Kernels that wait for rays continue in strips.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class AmbientLight;
class Atmosphere;
class VertexLight;
class CameraOutputs;
class Displacement;
class GatherCalls;
class KernelInputs;
class LightOutputs;
class LightPathStates;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;
class Transparency;
class WaitingKernels;

/// Runs surface kernels.
class SurfaceShading final : Stage {
public:
    explicit SurfaceShading(const StageSet&);
    /// If all surfaces of a batch are invisible, continues its rays without running a kernel. Returns false if the batch must be
    /// shaded.
    bool vanish(BatchContext&, Sched&);
    /// Shades a batch whose points, binding and kernel are set.
    void shade(const std::shared_ptr<BatchContext>&, Sched&);
    /// Completes points whose kernel has run. `asked`: by lane, rays that a waiting kernel has requested.
    void finish(BatchContext&, int first, int lanes, Sched&, std::span<const uint32_t> asked = {});
    /// Writes results other than light (distance, normal, outputs) to the call whose ray hit the point.
    void answerCall(const BatchContext&, int point, const Color& opacity, Sched&);

private:
    Accumulator& accumulator_;
    AmbientLight& ambient_;
    Atmosphere& atmosphere_;
    CameraOutputs& cameraOutputs_;
    Displacement& displacement_;
    GatherCalls& gathers_;
    KernelInputs& inputs_;
    LightOutputs& lightOutputs_;
    const LightPathStates& paths_;
    PhotonStage& photons_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    Transparency& transparency_;
    VertexLight& vertexLight_;
    WaitingKernels& waitingKernels_;
};

} // namespace alpenglow::integrator

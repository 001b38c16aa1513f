// Shade: the surface's kernel over a batch of points, its atmosphere, and what becomes of it: pairs become requests, what the
// surface gives by itself is deposited, rays go on behind what is not opaque. A kernel that waits for rays goes on in strips.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class AmbientLight;
class Atmosphere;
class BlockVertices;
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
class VertexLight;
class WaitingKernels;

class SurfaceShading final : Stage {
public:
    explicit SurfaceShading(const StageSet&);
    /// Where all of a batch are surfaces that show nothing its rays go on, and no kernel runs. False: it is to be shaded.
    bool vanish(BatchContext&, Sched&);
    /// Shades a batch whose points, binding and kernel are known.
    void shade(const std::shared_ptr<BatchContext>&, Sched&);
    /// Once the kernel has run at some points. `asked`: by lane, the rays that a waiting kernel has asked for there.
    void finish(BatchContext&, int first, int lanes, Sched&, std::span<const uint32_t> asked = {});
    /// What a call whose ray has met a point is told besides light.
    void tellAsker(const BatchContext&, int point, const Color& opacity, Sched&);

private:
    Accumulator& accumulator_;
    AmbientLight& ambient_;
    Atmosphere& atmosphere_;
    BlockVertices& blocks_;
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

} // namespace alpenglow::transport

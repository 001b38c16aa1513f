// Batches of groups whose kernel only requests light and reads no more than where rays met surfaces (shading::SurfaceRows): from
// hits to the rows of the kernel and of the blocks (blockvertices.h), with no structure a point.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class AmbientLight;
class BlockVertices;
class CameraOutputs;
class Flights;
class GatherCalls;
class KernelInputs;
class LightPathStates;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;
class SurfacePoints;
class SurfaceShading;
class Transparency;

class RowShading final : Stage {
public:
    explicit RowShading(const StageSet&);
    /// Whether hits of a group may be shaded so: SurfaceBinding::group, or one of those behind them.
    bool takes(size_t group) const { return group < takes_.size() && takes_[group]; }
    /// Shades the hits of a batch, and sends what goes on. False: only their rays and hits are as they were, and they must be
    /// shaded by points.
    bool shade(BatchContext&, Sched&);

private:
    bool takes(const SurfaceBinding&) const;
    void run(BatchContext&);
    void count(const BatchContext&);
    void requestOthers(BatchContext&, Sched&);
    void finish(BatchContext&, Sched&);

    Accumulator& accumulator_;
    AmbientLight& ambient_;
    BlockVertices& blocks_;
    CameraOutputs& cameraOutputs_;
    Flights& flights_;
    GatherCalls& gathers_;
    KernelInputs& inputs_;
    const LightPathStates& paths_;
    PhotonStage& photons_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
    SurfaceShading& shading_;
    Transparency& transparency_;
    std::vector<char> takes_; ///< by group
};

} // namespace alpenglow::transport

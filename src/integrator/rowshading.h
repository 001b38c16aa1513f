// Groups whose kernel only requests light and reads no more than the surface position (shading::SurfaceRows): goes from hits to
// the rows of the kernel and of the blocks (vertexblocks.h) without a structure for each point.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class AmbientLight;
class VertexLight;
class CameraOutputs;
class SegmentEvents;
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

/// Shades groups without a structure for each point.
class RowShading final : Stage {
public:
    explicit RowShading(const StageSet&);
    /// Whether hits of a group can be shaded this way. group: SurfaceBinding::group, or one for "hitmode" "primitive".
    bool takes(size_t group) const { return group < takes_.size() && takes_[group]; }
    /// Shades the hits of a batch and sends the next rays. Returns false if they must be shaded by points; only rays and hits are
    /// then valid.
    bool shade(BatchContext&, Sched&);

private:
    bool takes(const SurfaceBinding&) const;
    void run(BatchContext&);
    void count(const BatchContext&);
    void requestOthers(BatchContext&, Sched&);
    void finish(BatchContext&, Sched&);

    Accumulator& accumulator_;
    AmbientLight& ambient_;
    VertexLight& vertexLight_;
    CameraOutputs& cameraOutputs_;
    SegmentEvents& segmentEvents_;
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

} // namespace alpenglow::integrator

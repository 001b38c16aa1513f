// The stages of one thread by name. The constructor of a stage takes from here the references to the stages that it calls.
#pragma once

#include "integrator/names.h"

namespace alpenglow::integrator {

class Accumulator;
class AmbientLight;
class Atmosphere;
class BatchPool;
class VertexLight;
struct Context;
class CameraOutputs;
class DepthRays;
class Displacement;
class EmittedLight;
class SegmentEvents;
class GatherCalls;
class GuideRays;
class HitQueues;
class Intersector;
class IrradianceRecords;
class KernelInputs;
class LastSkies;
class LightKernels;
class LightOutputs;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class MediumEvents;
class NestedTrace;
class OcclusionCalls;
class Opacities;
class PhotonStage;
class RayStore;
class Requests;
class RowShading;
class ShadowRays;
class SubsurfaceWalks;
class SurfacePoints;
class SurfaceShading;
class Transparency;
class WaitingKernels;

/// References to the stages of one pipeline, which owns them.
struct StageSet {
    /// Each is described in the header of its class.
    Context& context;
    RayStore& store;
    LightPathStates& paths;
    Accumulator& accumulator;
    Intersector& intersector;
    HitQueues& queues;
    SurfacePoints& surfaces;
    SegmentEvents& segmentEvents;
    EmittedLight& emitted;
    LitSurfaces& litSurfaces;
    Transparency& transparency;
    LightKernels& lightKernels;
    NestedTrace& nested;
    MediumEvents& mediumEvents;
    OcclusionCalls& occlusion;
    IrradianceRecords& records;
    GatherCalls& gathers;
    GuideRays& guide;
    ShadowRays& shadows;
    Opacities& opacities;
    MediaStacks& media;
    Atmosphere& atmosphere;
    BatchPool& batches;
    KernelInputs& inputs;
    Displacement& displacement;
    CameraOutputs& cameraOutputs;
    SurfaceShading& shading;
    RowShading& rowShading;
    WaitingKernels& waitingKernels;
    Requests& requests;
    AmbientLight& ambient;
    VertexLight& vertexLight;
    SubsurfaceWalks& subsurface;
    PhotonStage& photons;
    LightOutputs& lightOutputs;
    DepthRays& depthRays;
    LastSkies& lastSkies;
};

} // namespace alpenglow::integrator

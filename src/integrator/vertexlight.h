// Lights the vertices of a batch, in blocks of 16 points: from the requests of kernels to shadow rays and the next rays. Under
// path one lobe of a point is followed, under the other hiders all. The stages, in their order:
//
//   VertexLoading   structures of the batch to columns                                        vertexloading.h
//   LobeRequests    arguments of calls to lobes; calls that rows cannot hold: SingleRequests  loberequests.h, singlerequests.h
//   LobeSelection   albedos, the energy rule, which lobe is followed with which chance        lobeselection.h
//   LightSampling   points on lights, and their radiance                                      lightsampling.h, chosenlights.h
//   Connection      what lobes reflect of it; shadow rays                                     connection.h
//   LastVertices    at the end of paths, skies that only rays would reach                     lastvertices.h
//   GuideScatter    rays of the caustic guide                                                 guidescatter.h
//   SpecularLights  light of point and distant lights by mirrors       specularlights.h
//   PhotonGather    light of nearby photons                                                   photongather.h
//   ScatterRays     directions, roulette, the next rays                                       scatterrays.h
//   PhotonFlight    for photons, in place of the stages from LobeSelection on                 photonflight.h
//
// No stage compares points, so results do not depend on the other members of the batch.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <memory>

namespace alpenglow::integrator {

class AmbientLight;
struct BlockLit;
class KernelStrip;
class LastSkies;
class PhotonStage;
struct StageSet;
class SubsurfaceWalks;
class SurfacePoints;
struct VertexStages;

/// Runs the stages over the vertices of a batch.
class VertexLight final : Stage {
public:
    explicit VertexLight(const StageSet&);
    ~VertexLight();
    /// Whether all requests of this kernel can be read in rows.
    bool takes(const BoundKernel&) const;
    /// Whether all requests of a batch whose kernel has run can.
    bool takes(const BatchContext&) const;
    /// Whether the rays that hit a batch allow it.
    bool takesRays(const BatchContext&) const;
    /// Reads the requests in rows, lights the points and sends the next rays; leaves shadow rays in ShadowRays::queue. Returns
    /// false, without effect, if requests must be made one by one.
    bool run(BatchContext&, Sched&);
    /// The same for the requests of suspended strips.
    bool run(BatchContext&, std::span<KernelStrip* const>, Sched&);
    /// The same for requests that were made one by one (Requests::lobes, AmbientLight::asked), all of points of this batch;
    /// removes them.
    void gather(BatchContext&, Sched&);
    /// The same for points inside a medium, with its phase function as lobe. lightDirected: by point,
    /// MediumEvents::lightDirection(). needsPoints(): whether the batch needs its points.
    void runMedium(BatchContext&, const Homogeneous&, std::span<const Vec3> lightDirected, Sched&);
    /// Whether stages read points of such surfaces, beyond the rows of positions.
    bool needsPoints(const SurfaceBinding&) const;
    /// Samples one light for such points and evaluates their lobes toward it, to `found`. False: not possible, no effect.
    bool lightMedium(const BatchContext&, const Homogeneous&, const BoundLight&, std::vector<BlockLit>& found);
    /// The same for exits of subsurface walks, where light is gathered as by diffuse(). indirect: by point, factor of its ray's
    /// light.
    void runExits(BatchContext&, std::span<const float> indirect, Sched&);
    /// For photons, at surfaces that scatter by a photon shading model alone: those without one as matte ones.
    void runModels(BatchContext&, Sched&);
    /// Reads the requests of a batch whose kernel has run, and follows none.
    void read(BatchContext&, Sched&);
    /// The stages that it runs.
    const VertexStages& stages() const;

private:
    struct Parts; ///< the stages
    bool takes(const BatchContext&, std::span<KernelStrip* const>) const;
    bool readRows(BatchContext&, bool waits);
    bool follow(BatchContext&, Sched&, bool waits);
    void followLobes(BatchContext&, Sched&);
    void beginMedium(std::span<const Vec3> lightDirected, float anisotropy);
    void beginExits(const BatchContext&);
    std::unique_ptr<Parts> parts_;
    const StageSet& set_;
    AmbientLight& ambient_;
    LastSkies& lastSkies_;
    PhotonStage& photons_;
    SubsurfaceWalks& subsurface_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

// Photons in the pipeline: interaction with surfaces, storage, and light from photon maps.
#pragma once
#include "integrator/context.h"
#include "integrator/photonjob.h"
#include "photonmap/photongrid.h"

namespace alpenglow::integrator {

class Accumulator;
class VertexLight;
class LightPathStates;
class MediaStacks;
class RayStore;
struct StageSet;
class SurfaceShading;
class Transparency;

/// A lobe of a photon shading model; current space.
struct ModelLobe {
    const LobeKind* kind = nullptr; ///< its formula
    Vec3 axis;                      ///< unit
    Color weight;                   ///< reflectance, by channel
    const RayKind* rays = nullptr;  ///< of the rays that continue
    float a = 0;                    ///< LobeParams::a
};
inline constexpr int kModelLobes = 2;           ///< most lobes of a model
inline constexpr uint32_t kModelSite = 0xfff00; ///< number of the first; larger than any call site of a shader

/// What photons do at surfaces, and what their maps give.
class PhotonStage final : Stage {
public:
    explicit PhotonStage(const StageSet&);
    /// Not null: the pipeline traces photons instead of camera rays.
    PhotonTrace* photonTrace() const { return photonTrace_.get(); }
    PhotonTrace& begin(); ///< switches the pipeline to photons
    /// The photons of the pass that a ray's sample uses; null: none.
    const photonmap::PhotonGrid* passOf(const PathRay& r) const {
        return r.sample && !photonTrace_ ? world_.photons()->pass(r.sample->sample) : nullptr;
    }
    /// Whether light of this emitter, which a ray hit, is already in the photons of its sample.
    bool bringsPhotons(const PathRay& r, int light) const {
        return (r.trail & shading::kTrailMirrored) && passOf(r) && world_.photons()->lightsOfPasses[size_t(light)];
    }
    /// The volumes at the origin of a photon; null: none.
    const shading::Media* aboutLight(const EmissionPlan::Light&, const struct EmissionStart&);
    void tilt(BatchContext&); ///< tilts photons along the normal by kLeastTilt
    /// Rays that gather photons receive the value of the surface's photon map, if it has one, and leave the batch.
    void takeGlobalMaps(BatchContext&, Sched&);
    /// Photons at surfaces with a photon shading model, or whose kernel waits for rays.
    void photonsByModel(BatchContext&, Sched&);
    /// The photon shading model of a point. all: surfaces without one have a matte one.
    PhotonModel modelAt(const BatchContext&, size_t point, bool all) const;
    /// The lobes of a model at a point; returns their number.
    static int lobesOfModel(PhotonModel, const ShadePoint&, const Color& Cs, ModelLobe (&to)[kModelLobes]);

private:
    const photonmap::PhotonMap* globalMapOf(int binding);
    std::unordered_map<int, const photonmap::PhotonMap*> globalMaps_; ///< by binding
    std::unique_ptr<PhotonTrace> photonTrace_;
    Accumulator& accumulator_;
    VertexLight& vertexLight_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    RayStore& store_;
    SurfaceShading& shading_;
    Transparency& transparency_;
};

} // namespace alpenglow::integrator

// Photons among the rays: what surfaces do to them, where they rest, and which light their maps bring to others.
#pragma once
#include "integrator/context.h"
#include "integrator/photonjob.h"
#include "photons/photongrid.h"

namespace alpenglow::transport {

class Accumulator;
class LightPathStates;
class MediaStacks;
class RayStore;
class Requests;
struct StageSet;
class SurfaceShading;
class Transparency;
class VertexLight;

class PhotonStage final : Stage {
public:
    explicit PhotonStage(const StageSet&);
    /// Not null: photons are followed, not what a camera sees.
    PhotonTrace* photonTrace() const { return photonTrace_.get(); }
    PhotonTrace& begin(); ///< from now on photons are followed
    /// The photons of a ray's sample; null: none.
    const photons::PhotonGrid* passOf(const PathRay& r) const {
        return r.sample && !photonTrace_ ? world_.photons_->pass(r.sample->sample) : nullptr;
    }
    /// Whether light of this emitter that a ray has met is among the photons of its sample.
    bool bringsPhotons(const PathRay& r, int light) const {
        return (r.trail & shading::kTrailMirrored) && passOf(r) && world_.photons_->lightsOfPasses[size_t(light)];
    }
    /// Lobes of a ray whose spread is below count as mirrors: radians. 0: none do.
    float narrowBelow(const PathRay&) const;
    /// The volumes in which a photon begins; null: none.
    const shading::Media* aboutLight(const EmissionPlan::Light&, const struct EmissionStart&);
    void tilt(BatchContext&); ///< ways along the normal, by kLeastTilt
    /// Of rays that gather photons, those whose surface has a map: they get what that says, and leave the batch.
    void takeGlobalMaps(BatchContext&, Sched&);
    /// Photons at points whose surfaces scatter them by a model, or whose kernel waits for rays.
    void photonsByModel(BatchContext&, Sched&);
    /// Lobes of the models of a batch's points in the place of those that its kernel asked for; `all`: of every point.
    void takeModels(BatchContext&, bool all);

private:
    const photons::PhotonMap* globalMapOf(int binding);
    std::unordered_map<int, const photons::PhotonMap*> globalMaps_; ///< by binding
    std::unique_ptr<PhotonTrace> photonTrace_;
    Accumulator& accumulator_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    RayStore& store_;
    Requests& requests_;
    SurfaceShading& shading_;
    Transparency& transparency_;
    VertexLight& vertexLight_;
};

} // namespace alpenglow::transport

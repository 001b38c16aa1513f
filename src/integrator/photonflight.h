// Photons at vertices: stored at lobes that are not deltas, and continued along a lobe with the adjoint power (photonfactor.cpp).
// Reads VertexBlocks::sites; writes PhotonTrace::out and rays.
#pragma once
#include "integrator/photonjob.h"
#include "integrator/vertexblocks.h"
#include <memory>
#include <optional>

namespace alpenglow::integrator {

class Accumulator;
class BatchPool;
class Intersector;
class KernelInputs;
class PhotonStage;
class SubsurfaceWalks;
class Transparency;
class VertexLight;

/// Stores and continues photons.
class PhotonFlight final : VertexStage {
public:
    PhotonFlight(const StageSet&, const VertexStages&);
    ~PhotonFlight();
    /// Whether the pipeline traces photons.
    bool on() const;
    /// After request(): replaces the lobes of points with a photon shading model. all: surfaces without one have a matte one.
    void takeModels(const BatchContext&, bool all);
    /// Sets LobeBlock::narrow, and boundless: paths sample the light from which a photon arrives here at any depth.
    void mark(BatchContext&);
    /// After LobeSelection::prepare(): stores the photons and sends them on.
    void follow(BatchContext&, Sched&);

private:
    /// A photon that a narrow lobe sends on.
    struct Turned {
        size_t point;
        int site; ///< of the lobe
    };
    Site& modelSite(size_t first, int k, const struct ModelLobe&);
    void limitDepths(const BatchContext&);
    void limitDepth(size_t block, const BatchContext&);
    std::optional<PhotonDepths> depthsBehind(const PathRay&, const SurfaceBinding&, bool diffuse) const;
    bool follows(const Site&, size_t point, const BatchContext&) const;
    void pick(BatchContext&);
    void rest(const BatchContext&);
    void restAt(size_t point, const BatchContext&);
    void send(size_t block, BatchContext&, Sched&);
    void extend(size_t block, BatchContext&);
    bool extendAt(size_t block, size_t lane, BatchContext&);
    bool endsProbe(size_t block, size_t lane, const BatchContext&);
    float photonWay(const Site&, size_t point, const BatchContext&, Vec3& w) const;
    float survival(const PathRay&, const Color& request, const Color& weight, float dice) const;
    void keep(size_t block, const BatchContext&);
    // photonlookback.cpp
    void lookBack(const BatchContext&, Sched&);
    void shadeBack(BatchContext&, const BatchContext& from);
    bool isLit(const Site&, size_t point, const BatchContext&) const;
    void valueBack(size_t block, Lanes turned, const BatchContext& seen, const BatchContext&);
    Lanes sumBack(size_t block, Lanes turned, const BatchContext& seen, const BatchContext&, Color* sum);
    void densityBack(size_t block, Lanes turned, const BatchContext&, float* density);
    float energyScale(const Color& reflected, const Color& clear, const SurfaceBinding&) const;

    std::vector<ScatterBlock> picked_;  ///< by block: the lobes that photons follow, and their directions
    std::vector<Turned> turned_;        ///< photons along narrow lobes
    std::vector<Color> back_;           ///< by point, for these: value of the reverse path over the density
    std::unique_ptr<VertexLight> seen_; ///< the lobes of their points as paths see them
    const StageSet& set_;
    LobeLanesList lanes_;
    Accumulator& accumulator_;
    BatchPool& batches_;
    PhotonGather& gathered_;
    KernelInputs& inputs_;
    Intersector& intersector_;
    PhotonStage& photons_;
    ScatterRays& scatter_;
    LobeSelection& selection_;
    RayStore& store_;
    SubsurfaceWalks& subsurface_;
    Transparency& transparency_;
};

} // namespace alpenglow::integrator

// Photons at vertices: storing them, continuing along lobes with the adjoint power, and density estimation for paths.
#pragma once
#include "integrator/photonjob.h"
#include "integrator/scatterrays.h"
#include <optional>

namespace alpenglow::integrator {

class BatchPool;
class GuideRays;
class Intersector;
class KernelInputs;
class ShadowRays;
class Transparency;

class PhotonScatter final : VertexStage {
public:
    PhotonScatter(const StageSet&, const VertexLobes&, LobeSelection&, ScatterRays&);
    /// Whether photons treat a lobe as a mirror. `below`: PhotonStage::narrowBelow(); in: unit direction of the ray that hit the
    /// point.
    bool isNarrow(const LobeVertex&, float below, const Vec3& in) const;
    uint8_t trailBehind(const LobeVertex&) const; ///< PathRay::trail
    /// Whether a guided path continues along a lobe: a delta lobe that adds to the light of its point.
    static bool mirrorsPath(const LobeVertex& l) { return l.delta && l.below < 0 && !l.ownsTarget; }
    bool leftToPhotons(const LobeVertex&, const BoundLight&) const;
    bool sampledByPaths(const LobeVertex&) const;
    /// For a photon that continues along a lobe; without a value the depth limits of the surfaces end it.
    std::optional<PhotonDepths> depthsBehind(const LobeVertex&, const SurfaceBinding&) const;
    void restPhotons();
    void lookBack(Sched&); ///< LobeRay::back
    float photonWay(const LobeVertex&, Vec3& w) const;
    /// Adds the light of nearby photons to lobes.
    void takePhotons(Sched&);

private:
    bool spreads(const LobeVertex&) const;
    bool mirrors(const LobeVertex&) const;
    bool seesAll(const LobeVertex&) const;
    bool lit(const LobeVertex&) const;
    std::shared_ptr<BatchContext> shadeBack(std::span<LobeRay* const> turned, Sched&);
    Color givenBack(const LobeVertex&);
    struct Near {
        Vec3 from;
        Color light; ///< radiance times steradians
    };
    std::vector<Near> near_; ///< photons near a point
    LobeSelection& selection_;
    ScatterRays& scatter_;
    Accumulator& accumulator_;
    BatchPool& batches_;
    GuideRays& guide_;
    Intersector& intersector_;
    KernelInputs& inputs_;
    const LightPathStates& paths_;
    PhotonStage& photons_;
    ShadowRays& shadows_;
    Transparency& transparency_;
};

} // namespace alpenglow::integrator

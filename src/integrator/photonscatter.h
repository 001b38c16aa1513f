// Photons at vertices: where they rest, along which lobes they go on and with which power, and what paths gather of them.
#pragma once
#include "integrator/photonjob.h"
#include "integrator/scatterrays.h"
#include <optional>

namespace alpenglow::transport {

class BatchPool;
class GuideRays;
class Intersector;
class KernelInputs;
class ShadowRays;
class Transparency;

class PhotonScatter final : VertexStage {
public:
    PhotonScatter(const StageSet&, const VertexLobes&, LobeSelection&, ScatterRays&);
    /// `below`: PhotonStage::narrowBelow(); in: the direction from which the lobe's point was seen, unit.
    bool isNarrow(const LobeVertex&, float below, const Vec3& in) const;
    uint8_t trailBehind(const LobeVertex&) const; ///< PathRay::trail
    /// Whether a guided path goes on along a lobe: a single direction whose light adds to that of its point.
    static bool mirrorsPath(const LobeVertex& l) { return l.delta && l.below < 0 && !l.ownsTarget; }
    bool leftToPhotons(const LobeVertex&, const BoundLight&) const;
    bool sampledByPaths(const LobeVertex&) const;
    /// Of a photon that goes on along a lobe; nothing: the surfaces' depths end its way.
    std::optional<PhotonDepths> depthsBehind(const LobeVertex&, const SurfaceBinding&) const;
    void restPhotons();
    void lookBack(Sched&); ///< LobeRay::back
    float photonWay(const LobeVertex&, Vec3& w) const;
    /// Gives lobes what they send on of the photons about their points.
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
    std::vector<Near> near_; ///< photons about a point
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

} // namespace alpenglow::transport

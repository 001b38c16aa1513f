// Interprets the requests of kernels (docs/light.md): collects lobes, and makes shadow rays.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"
#include <map>

namespace alpenglow::integrator {

class Accumulator;
class AmbientLight;
class IrradianceRecords;
class LightPathStates;
class LitSurfaces;
class MediaStacks;
class OcclusionCalls;
class PhotonStage;
class RayStore;
class ShadowRays;
struct StageSet;
class SubsurfaceWalks;

/// A lobe of a batch, and the pair that requested it.
struct AskedLobe {
    int lobe, record, lane; ///< index in Requests::lobes; EmitRecord of the pair, and its lane
};

/// Requests answered by shadow rays: their weights include the throughput of the ray.
inline bool asksShadows(SiteKind k) { return k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Ambient; }

/// Turns the pairs of kernels into lobes and shadow rays.
class Requests final : Stage {
public:
    explicit Requests(const StageSet&);
    /// Interprets the pairs of a kernel that did not wait. `asked`: receives the lobes; may be null. lobesToo false: all but
    /// lobes.
    void requestPairs(BatchContext&, std::vector<AskedLobe>* asked, Sched&, bool lobesToo = true);
    /// Interprets one call. `in`: argument rows. owns: LobeVertex::ownsTarget.
    void request(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, AccumulatorId,
                 bool owns, uint32_t occurrence);
    /// `in`: argument rows, followed by two rows: ShadowReach::radius and the vertex for random numbers.
    void lightVisibility(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight,
                         AccumulatorId);
    /// Radiance of the environment map of a trace() in direction w (unit, current space).
    Color mapTowards(const TraceSite&, const Vec3& w, float spread) const;
    /// Drops what a call that was interrupted has left.
    void clear();

    std::vector<LobeVertex> lobes; ///< requested so far
    BsdfBatch rows;                ///< of `lobes`
    std::vector<int> apartAt; ///< points of the batch that request indirect light separate from direct light (rsl::kPairApart)

private:
    void requestShadows(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row, const Color& weight,
                        AccumulatorId, bool owns, uint32_t occurrence);
    template <class Row> const LobeKind* lobeOf(const BatchContext&, const SiteInfo&, const Row&);
    template <class Row> const RayKind* raysOfTrace(const SiteInfo&, const Row&, const ShadePoint&);
    template <class Row>
    bool askOfTrace(const BatchContext&, const SiteInfo&, const ShadePoint&, const Row&, LobeVertex&, LobeParams&);
    std::map<std::pair<const rsl::ir::Site*, int32_t>, const LobeKind*> lobesNamed_; ///< by names that calls computed
    std::vector<uint32_t> occurrence_;
    Accumulator& accumulator_;
    AmbientLight& ambient_;
    IrradianceRecords& records_;
    const LightPathStates& paths_;
    LitSurfaces& litSurfaces_;
    MediaStacks& media_;
    OcclusionCalls& occlusion_;
    PhotonStage& photons_;
    RayStore& store_;
    ShadowRays& shadows_;
    SubsurfaceWalks& subsurface_;
};

} // namespace alpenglow::integrator

// Requests: what calls of a kernel ask for at points (docs/light.md): lobes, which are gathered here until light is found over
// them, and shadow rays.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/vertex.h"
#include <map>

namespace alpenglow::transport {

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

/// A lobe of a batch, and the pair that it came from.
struct AskedLobe {
    int lobe, record, lane;
};

/// Questions that shadow rays answer: their weights hold the ray's throughput.
inline bool asksShadows(SiteKind k) { return k == SiteKind::Transmission || k == SiteKind::Occlusion || k == SiteKind::Ambient; }

class Requests final : Stage {
public:
    explicit Requests(const StageSet&);
    /// What the pairs of a kernel that did not wait ask for. `asked`: gets the lobes; may be null. lobesToo false: all but lobes.
    void requestPairs(BatchContext&, std::vector<AskedLobe>* asked, Sched&, bool lobesToo = true);
    /// One call. `in`: rows of its arguments. owns: LobeVertex::ownsTarget.
    void request(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId,
                 bool owns, uint32_t occurrence);
    /// `in`: rows of the call's arguments, and behind them two: ShadowReach::radius and the vertex of its random numbers.
    void lightVisibility(BatchContext&, const SiteInfo&, int point, const float* in, int lanes, int lane, Color weight, TargetId);
    /// The environment map of a trace() in direction w (unit, current space).
    Color mapTowards(const TraceSite&, const Vec3& w, float spread) const;
    void clear();

    std::vector<LobeVertex> lobes; ///< that were asked for
    LobeColumns rows;              ///< of `lobes`
    std::vector<int> apartAt;      ///< points of the batch that ask for indirect light beside direct light (rsl::kPairApart)

private:
    void requestShadows(BatchContext&, const SiteInfo&, int point, const std::function<float(int)>& row, const Color& weight,
                        TargetId, bool owns, uint32_t occurrence);
    template <class Row> const LobeKind* lobeOf(const BatchContext&, const SiteInfo&, const Row&);
    template <class Row> const RayKind* raysOfTrace(const SiteInfo&, const Row&, const ShadePoint&);
    template <class Row>
    bool askOfTrace(const BatchContext&, const SiteInfo&, const ShadePoint&, const Row&, LobeVertex&, LobeParams&);
    std::map<std::pair<const rsl::ir::Site*, int32_t>, const LobeKind*> lobesNamed_; ///< of names that calls have made
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

} // namespace alpenglow::transport

// Hemisphere calls: rays of occlusion() and indirectdiffuse(), and the shape attributes that control them.
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <map>

namespace alpenglow::integrator {

class Accumulator;
class Intersector;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;
class SurfacePoints;

/// Makes the rays of hemisphere calls.
class OcclusionCalls final : Stage {
public:
    explicit OcclusionCalls(const StageSet&);
    /// Makes the rays of an occlusion() at p, for `out`: `weight` is their total contribution when unoccluded.
    void hemisphereRays(const BatchContext&, const SiteInfo&, const ShadePoint& p, const Vec3& at, const geometry::SurfacePoint*,
                        const std::function<float(int)>& row, const Color& weight, AccumulatorId, uint32_t site,
                        uint32_t occurrence, std::vector<ShadowRay>& out);
    /// Contribution of one such ray with this transmittance, 0 to 1; adds further results to `sums`, which may be null.
    Color openLight(const ShadowRay&, const Color& transmitted, TraceSums* sums) const;
    /// Number of samples for a call whose shader requests `asked`: Attribute "irradiance" "nsamples" of the shape if that is 0;
    /// at most 4096, larger values are reported once.
    int samplesOf(float asked, const geometry::Shape*, const SiteInfo&, const BatchContext&);
    /// Values from the attributes of a shape: samples, and bias (< 0: none).
    struct OfShape {
        int samples;
        float bias;
    };
    /// Computed at first use; null: no shape.
    const OfShape& ofShape(const geometry::Shape*);
    /// Records whether the calling surface itself occludes the hemisphere about a unit normal.
    void noteTurnedAway(const BatchContext&, const SiteInfo&, int point, const Vec3& normal);

    std::vector<HemisphereRays> hemispheres; ///< indexed by the rays in ShadowRays::queue

private:
    int fewer(const OcclusionSite&, const std::function<float(int)>& row, int count, const BatchContext&) const;
    bool agree(std::vector<ShadowRay>&, size_t begin, HemisphereRays&, const Color& weight);
    FlippedNormals::Tally* tallyOf(const BatchContext&, const SiteInfo&, const ShadePoint&, const Vec3& normal);
    NumberRows numbers_; ///< for the rays of one call
    std::unordered_map<const scene::Attributes*, OfShape> ofShapes_;
    std::map<std::pair<const SiteInfo*, const geometry::Shape*>, FlippedNormals::Tally*> tallies_;
    Accumulator& accumulator_;
    Intersector& intersector_;
    PhotonStage& photons_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::integrator

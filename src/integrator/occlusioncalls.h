// Calls that look about a hemisphere: occlusion(), indirectdiffuse(): their rays, and what is said of shapes before them.
#pragma once
#include "base/numberlanes.h"
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include <map>

namespace alpenglow::transport {

class Accumulator;
class Intersector;
class PhotonStage;
class RayStore;
class Requests;
class ShadowRays;
struct StageSet;
class SurfacePoints;

class OcclusionCalls final : Stage {
public:
    explicit OcclusionCalls(const StageSet&);
    /// The rays of an occlusion() at p, for `out`: together they bring `weight` where nothing is met.
    void hemisphereRays(const BatchContext&, const SiteInfo&, const ShadePoint& p, const Vec3& at, const geometry::SurfacePoint*,
                        const std::function<float(int)>& row, const Color& weight, TargetId, uint32_t site, uint32_t occurrence,
                        std::vector<ShadowRay>& out);
    /// What one of them brings of which so much came through, 0 to 1; what it tells besides goes to `sums`, which may be null.
    Color openLight(const ShadowRay&, const Color& transmitted, TraceSums* sums) const;
    /// How many samples a call sends, whose shader says `asked`: Attribute "irradiance" "nsamples" of the shape where that is
    /// nothing, 4096 at most; more are reported once.
    int samplesOf(float asked, const geometry::Shape*, const SiteInfo&, const BatchContext&);
    /// What the attributes of a shape say: samples, and the bias, < 0 where there is none.
    struct OfShape {
        int samples;
        float bias;
    };
    const OfShape& ofShape(const geometry::Shape*);
    /// Notes of a call that looks for light about a unit normal whether its own primitive is before it.
    void noteTurnedAway(const BatchContext&, const SiteInfo&, int point, const Vec3& normal);

    std::vector<HemisphereRays> hemispheres; ///< of ShadowRays::queue

private:
    int fewer(const OcclusionSite&, const std::function<float(int)>& row, int count, const BatchContext&) const;
    bool agree(std::vector<ShadowRay>&, size_t begin, HemisphereRays&, const Color& weight);
    TurnedAway::Tally* tallyOf(const BatchContext&, const SiteInfo&, const ShadePoint&, const Vec3& normal);
    render::NumberRows numbers_; ///< of the rays of one call
    std::unordered_map<const scene::Attributes*, OfShape> ofShapes_;
    std::map<std::pair<const SiteInfo*, const geometry::Shape*>, TurnedAway::Tally*> tallies_;
    Accumulator& accumulator_;
    Intersector& intersector_;
    PhotonStage& photons_;
    RayStore& store_;
    Requests& requests_;
    ShadowRays& shadows_;
    SurfacePoints& surfaces_;
};

} // namespace alpenglow::transport

// What rays share or rarely have: camera samples, kinds of rays, sets of shapes, and what only some rays carry (RayExtra).
// Reads PathRay. Costs nothing a ray without extras; a kind is found by hash where it is not the last one.
#pragma once
#include "answers/random.h"
#include "integrator/context.h"
#include <deque>
#include <map>

namespace alpenglow::transport {

struct BatchContext;
struct CameraRay;
struct StageSet;

class RayStore final : Stage {
public:
    explicit RayStore(const StageSet&);
    /// The one that stays, of a kind that is made.
    const RayKind* kindOf(const RayKind&);
    /// The random numbers of a ray's camera sample.
    Random random(const PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample.numbers); }
    /// Between levels of detail: what a camera ray meets on its whole way, 0 to 1.
    float levelOf(const CameraRay&) const;

    /// For one call. f: a row of its arguments; from: the shape whose shader calls, or null, whose Attribute "grouping"
    /// "tracesubset" holds where no subset is given. Also gives the type and the label of the rays.
    shading::RaySet raySetOf(const SiteInfo&, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                             int32_t& label);

    const RayExtra& extraOf(const PathRay& r) const { return r.extra < 0 ? noExtra_ : extras_[size_t(r.extra)]; }
    /// The same, of a ray that has one.
    RayExtra& ownExtra(const PathRay& r) { return extras_[size_t(r.extra)]; }
    /// For PathRay::extra of one ray, which has it alone: freeExtra() when its points are shaded. -1 where there is nothing in
    /// it.
    int32_t newExtra(const RayExtra&);
    void freeExtras(BatchContext&);
    void freeExtra(const PathRay& r) {
        if (r.extra >= 0) freeExtras_.push_back(r.extra);
    }
    void forgetExtras();
    /// What a ray meets counts less far away, where its call says so. way: from its origin to what it met.
    void fade(PathRay&, float way);
    /// From here on what rays bring is of surfaces: the light of emitters is in their targets.
    void keepIndirect(BatchContext&);

    std::vector<PathSample> samples; ///< of the call of trace()
    PathSample noSample;             ///< of rays without one

private:
    const uint8_t* shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from);
    std::vector<RayExtra> extras_;
    std::vector<int32_t> freeExtras_;
    const RayExtra noExtra_;
    std::unordered_map<uint64_t, std::deque<RayKind>> kinds_; ///< by hash
    const RayKind* lastKind_ = nullptr;
    std::map<std::tuple<int32_t, int32_t, const scene::Attributes*>, const uint8_t*> subsetsKnown_;
};

} // namespace alpenglow::transport

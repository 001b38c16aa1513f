// Data that rays share or rarely have: camera samples, kinds of rays, sets of shapes, and RayExtra. Reads PathRay. Costs nothing
// for rays without extras; a kind is looked up by hash unless it is the last one used.
#pragma once
#include "integrator/context.h"
#include "services/random.h"
#include <deque>
#include <map>

namespace alpenglow::integrator {

struct BatchContext;
struct CameraRay;
struct StageSet;

/// Keeps what rays refer to until all rays of a call are traced.
class RayStore final : Stage {
public:
    explicit RayStore(const StageSet&);
    /// The permanent copy of a kind of ray.
    const RayKind* kindOf(const RayKind&);
    /// The random numbers of a ray's camera sample.
    Random random(const PathRay& r) const { return Random(r.sample ? r.sample->numbers : noSample.numbers); }
    /// Random number that selects the level of detail for all rays of a camera sample, 0 to 1.
    float levelOf(const CameraRay&) const;

    /// The set of shapes for the rays of one call. f: a row of its arguments; from: the shape that calls, or null; its Attribute
    /// "grouping" "tracesubset" applies if the call gives no subset. Also returns type and label of the rays.
    shading::RaySet raySetOf(const SiteInfo&, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type,
                             int32_t& label);

    /// Defaults where the ray has none.
    const RayExtra& extraOf(const PathRay& r) const { return r.extra < 0 ? noExtra_ : extras_[size_t(r.extra)]; }
    /// The extras of a ray that has some.
    RayExtra& ownExtra(const PathRay& r) { return extras_[size_t(r.extra)]; }
    /// Stores extras for one ray, as PathRay::extra; free them with freeExtra() after its hit is shaded. Returns -1 for default
    /// values.
    int32_t newExtra(const RayExtra&);
    /// Free the extras of the rays of a batch, or of one ray; drop all.
    void freeExtras(BatchContext&);
    void freeExtra(const PathRay& r) {
        if (r.extra >= 0) freeExtras_.push_back(r.extra);
    }
    void forgetExtras();
    /// Attenuates a ray by the "falloff" of its call. way: distance from its origin to its hit.
    void fade(PathRay&, float way);
    /// From here on rays of the batch carry light of surfaces only: emission has been added to their targets. Applies
    /// RayExtra::indirect.
    void keepIndirect(BatchContext&);

    std::vector<PathSample> samples; ///< of the current trace()
    PathSample noSample;             ///< for rays without a sample

private:
    const uint8_t* shapesOf(int32_t subset, int32_t exclude, const scene::Attributes* from);
    std::vector<RayExtra> extras_;
    std::vector<int32_t> freeExtras_;
    const RayExtra noExtra_;
    std::unordered_map<uint64_t, std::deque<RayKind>> kinds_; ///< by hash
    const RayKind* lastKind_ = nullptr;
    std::map<std::tuple<int32_t, int32_t, const scene::Attributes*>, const uint8_t*> subsetsKnown_;
};

} // namespace alpenglow::integrator

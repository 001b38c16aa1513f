// Shadow rays: computes the transmittance along each, 0 to 1, and adds the light to its target. Reads `queue` and related arrays.
// Tests opaque surfaces first, by any hit; others only if the ray passes their bounding box.
#pragma once
#include "integrator/context.h"

namespace alpenglow::integrator {

class Accumulator;
class SegmentEvents;
class Intersector;
class IrradianceRecords;
class LightPathStates;
class MediaStacks;
class OcclusionCalls;
class Opacities;
class RayStore;
struct StageSet;

/// Traces queued shadow rays.
class ShadowRays final : Stage {
public:
    explicit ShadowRays(const StageSet&);
    /// Transmittance along each ray. ShadowRay::ray: random numbers and footprint for shaders on the way.
    void transmittances(std::span<const ShadowRay>, std::span<Color> out);
    /// Of one ray.
    Color transmittance(const ShadowRay&);
    /// Makes the rays of a transmission() from a to b, for `out`: as many as requested, each with its share of `weight`.
    void transmissionRays(const SiteInfo&, const ShadePoint&, const Vec3& at, const geometry::SurfacePoint*,
                          const std::function<float(int)>& row, const Color& weight, AccumulatorId, uint32_t site,
                          uint32_t occurrence, std::vector<ShadowRay>& out);
    /// Traces the queue, adds the light, and empties the queue.
    void flush(Sched&);
    /// Drops the queue.
    void clear();
    size_t bytes() const; ///< memory of the queue

    /// Notes the light sample of the last ray of the queue for Context::seen, if it is not occluded.
    void note(const SeenSample& s) {
        if (context_.seen) noted_.push_back({s, queue.size() - 1});
    }

    std::vector<ShadowRay> queue;      ///< rays to be traced
    std::vector<MoreLight> more;       ///< further light along rays of the queue
    std::vector<Contribution> settled; ///< contributions that need no ray, added with the queue

    /// For worlds with WorldImpl::shadowVisibility_: light along a ray of the queue if rays of the lobe cannot find it.
    struct AloneLight {
        size_t ray;     ///< index in the queue
        int32_t more;   ///< index in `more`; -1: the ray's own contribution
        Color light;    ///< without multiple importance sampling
        uint32_t lobes; ///< visibility bit of the rays of the lobe
    };
    std::vector<AloneLight> alone;

private:
    class Passing;
    void passSurfaces(std::span<const ShadowRay>, std::span<Color> out); ///< transmittance of surfaces and media
    /// Whether opaque surfaces are tested first and separately, and others only where a ray may hit them.
    bool intersectsOnlyOpaque(const ShadowRay&) const;
    void roulette(const Sched&); ///< removes rays of little light at random
    void takeAlone();            ///< replaces contributions by those of `alone` where only the shadow ray finds the light
    void blockedByOpaque(std::span<const ShadowRay>, std::span<Color> out);
    void blockedByAll(std::span<const ShadowRay>, std::span<Color> out);
    std::vector<std::pair<SeenSample, size_t>> noted_; ///< with its ray in the queue
    std::vector<uint16_t> straights_; ///< by ray: surfaces passed straight through; filled only for light path outputs
    std::vector<uint8_t> differs_;    ///< by ray: passed a surface with Opacity::differs; empty: none did
    std::vector<Color> transmitted_;
    std::vector<accel::Ray> rays_;
    std::vector<uint8_t> blocked_;
    Accumulator& accumulator_;
    SegmentEvents& segmentEvents_;
    Intersector& intersector_;
    IrradianceRecords& records_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    OcclusionCalls& occlusion_;
    Opacities& opacities_;
    RayStore& store_;
};

} // namespace alpenglow::integrator

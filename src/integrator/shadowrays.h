// Shadow rays: what is left of the light along each, 0 to 1, and where it is added. Reads `queue` and what goes with it; deposits
// light. Opaque surfaces are looked for first, by any hit; others only where a ray passes their box.
#pragma once
#include "integrator/context.h"

namespace alpenglow::transport {

class Accumulator;
class Flights;
class Intersector;
class IrradianceRecords;
class LightPathStates;
class MediaStacks;
class OcclusionCalls;
class Opacities;
class RayStore;
struct StageSet;

class ShadowRays final : Stage {
public:
    explicit ShadowRays(const StageSet&);
    /// What is left of light along each ray. ShadowRay::ray: for the random numbers and footprint of shaders on the way.
    void transmittances(std::span<const ShadowRay>, std::span<Color> out);
    Color transmittance(const ShadowRay&);
    /// The rays of a transmission() from a to b, for `out`: as many as it asks for, each with its share of `weight`.
    void transmissionRays(const SiteInfo&, const ShadePoint&, const Vec3& at, const geometry::SurfacePoint*,
                          const std::function<float(int)>& row, const Color& weight, TargetId, uint32_t site, uint32_t occurrence,
                          std::vector<ShadowRay>& out);
    /// Follows the queue, deposits what arrives, and empties it.
    void flush(Sched&);
    void clear();

    std::vector<ShadowRay> queue;
    std::vector<MoreLight> more;  ///< of the queue: what else goes the same way
    std::vector<Deposit> settled; ///< of calls that no ray is sent for any more; taken with the queue

private:
    class Passing;
    void passSurfaces(std::span<const ShadowRay>, std::span<Color> out); ///< what surfaces and media leave
    /// Whether surfaces that block all light are looked for first and by themselves, the others only where a ray may meet them.
    bool meetsOpaqueAlone(const ShadowRay&) const;
    void blockedByOpaque(std::span<const ShadowRay>, std::span<Color> out);
    void blockedByAll(std::span<const ShadowRay>, std::span<Color> out);
    std::vector<uint16_t> straights_; ///< by ray, surfaces that it went straight through; where somebody asks
    std::vector<Color> transmitted_;
    std::vector<accel::Ray> rays_;
    std::vector<uint8_t> blocked_;
    Accumulator& accumulator_;
    Flights& flights_;
    Intersector& intersector_;
    IrradianceRecords& records_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    OcclusionCalls& occlusion_;
    Opacities& opacities_;
    RayStore& store_;
};

} // namespace alpenglow::transport

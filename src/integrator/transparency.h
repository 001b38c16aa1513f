// Transparency: weight of light from behind shaded points, 0 to 1, and the rays that continue there.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class GuideRays;
class LightPathStates;
class MediaStacks;
class PhotonStage;
class RayStore;
struct StageSet;

/// Whether all points of a batch that has run are opaque.
bool isOpaque(const shading::Batch&);

/// Continues rays behind transparent surfaces.
class Transparency final : Stage {
public:
    explicit Transparency(const StageSet&);
    /// Sets BatchContext::clear and passes from the transparency at each point, for choosing between lobes and continuation.
    void setTransparency(BatchContext&);
    /// Transparency of a shaded point, including the volume before it.
    Color clearAt(const BatchContext&, int point) const;
    /// Weight of a continuing ray: clearAt(); larger for photons at one-sided surfaces.
    Color goesOn(const BatchContext&, int point) const;
    Color leftBehind(const BatchContext&, int point) const; ///< transmittance of the volume before the point
    /// Continues a ray behind a point. `chance`: probability of this choice; `asked`: rays that a waiting kernel has requested
    /// there.
    void continueBehind(const SurfaceBinding&, const PathRay&, AccumulatorId, const ShadePoint&, const Color& transparency,
                        float chance, uint32_t asked, Sched&);

private:
    const GuideRays& guide_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    PhotonStage& photons_;
    RayStore& store_;
};

} // namespace alpenglow::integrator

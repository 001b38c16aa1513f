// Transparency: what comes through at shaded points, 0 to 1, and the rays that go on behind them.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class GuideRays;
class LightPathStates;
class MediaStacks;
class PhotonStage;
class RayStore;
struct StageSet;

/// Whether nothing goes on behind any point of a batch that has run.
bool isOpaque(const shading::Batch&);

class Transparency final : Stage {
public:
    explicit Transparency(const StageSet&);
    /// BatchContext::clear and passes: what comes through at each point, which decides which ray goes on.
    void tellClear(BatchContext&);
    /// The share of the light from behind a shaded point that comes through.
    Color clearAt(const BatchContext&, int point) const;
    /// Of a ray, what goes on behind its point: clearAt(), of some photons more.
    Color goesOn(const BatchContext&, int point) const;
    Color leftBehind(const BatchContext&, int point) const; ///< of it, by what the volume before the point takes
    /// Goes on behind a point. `chance`: with which it was chosen to; `asked`: rays that a waiting kernel has asked for there.
    void passThrough(const SurfaceBinding&, const PathRay&, TargetId, const ShadePoint&, const Color& transparency, float chance,
                     uint32_t asked, Sched&);

private:
    const GuideRays& guide_;
    const LightPathStates& paths_;
    MediaStacks& media_;
    PhotonStage& photons_;
    RayStore& store_;
};

} // namespace alpenglow::transport

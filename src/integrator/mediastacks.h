// Interior and Exterior (RISpec 3.2): which volumes rays are in, and what these take of shadow rays.
#pragma once
#include "answers/kernelrun.h"
#include "integrator/context.h"
#include <deque>

namespace alpenglow::transport {

class Atmosphere;
struct StageSet;

/// A part of a shadow ray inside a medium.
struct MediumPart {
    int medium;
    size_t ray;
    Vec3 from, to;
};

class MediaStacks final : Stage {
public:
    explicit MediaStacks(const StageSet&);
    static int mediumOf(const shading::Media* m) { return m ? m->top() : -1; }
    /// Where a ray from a point of a batch in direction w begins.
    const shading::Media* towards(const KernelRun&, int point, const Vec3& w);
    /// SurfaceBinding::beyond().
    const shading::Media* beyond(const SurfaceBinding&, const shading::Media* from, const Vec3& n, const Vec3& in,
                                 const Vec3& to);
    const shading::Media* kept(const shading::Media&);             ///< the same, for good; null where it is none
    void tellLost(const shading::Media*, const ShadePoint&) const; ///< says once that a ray was in more volumes than are known
    /// Where shadow rays between a and b begin, one of which may be the point `at` of a surface. Those that end there are turned
    /// about.
    void shadowsInMedia(std::span<ShadowRay>, const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint*,
                        const SurfaceBinding*);
    /// Takes from `out`, by ray, what the media leave of light.
    void dim(std::span<const MediumPart>, std::span<const ShadowRay>, std::span<Color> out);

private:
    std::deque<shading::Media> known_;
    Atmosphere& atmosphere_;
};

} // namespace alpenglow::transport

// Interior and Exterior (RISpec 3.2): the volumes that rays are inside of, and their transmittance for shadow rays.
#pragma once
#include "integrator/context.h"
#include "services/kernelrun.h"
#include <deque>

namespace alpenglow::integrator {

class Atmosphere;
struct StageSet;

/// A segment of a shadow ray inside a medium.
struct MediumPart {
    int medium;
    size_t ray;    ///< index in the list of rays
    Vec3 from, to; ///< camera space
};

/// Keeps the volumes of rays, and attenuates shadow rays in them.
class MediaStacks final : Stage {
public:
    explicit MediaStacks(const StageSet&);
    /// Of WorldImpl::media(): the active one; -1: a vacuum.
    static int mediumOf(const shading::Media* m) { return m ? m->top() : -1; }
    /// The media at the start of a ray from a point of a batch in direction w.
    const shading::Media* towards(const KernelRun&, int point, const Vec3& w);
    /// SurfaceBinding::beyond().
    const shading::Media* beyond(const SurfaceBinding&, const shading::Media* from, const Vec3& n, const Vec3& in,
                                 const Vec3& to);
    const shading::Media* kept(const shading::Media&); ///< returns a permanent copy; null if empty
    void reportLost(const shading::Media*,
                    const ShadePoint&) const; ///< warns once that a ray was in more volumes than are tracked
    /// Sets the media at the start of shadow rays between a and b, one of which may be the surface point `at`. Rays that end
    /// there are reversed, because the media are known there.
    void shadowsInMedia(std::span<ShadowRay>, const Vec3& a, const Vec3& b, const Vec3& at, const geometry::SurfacePoint*,
                        const SurfaceBinding*);
    /// Multiplies `out`, by ray, by the transmittance of the media.
    void dim(std::span<const MediumPart>, std::span<const ShadowRay>, std::span<Color> out);

private:
    std::deque<shading::Media> known_;
    Atmosphere& atmosphere_;
};

} // namespace alpenglow::integrator

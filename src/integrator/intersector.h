// Intersection: nearest hits and occlusion of rays. Reads PathRay; writes a hit for each. Small scenes are searched in rows of 16
// rays, others ray by ray, camera rays always together. Costs 30 to 500 ns a ray (bench/RESULTS.md).
#pragma once
#include "integrator/context.h"

namespace alpenglow::integrator {

struct StageSet;

/// Finds what rays hit. Every ray passes through it.
class Intersector final : Stage {
public:
    explicit Intersector(const StageSet&);
    /// intersect(): nearest hits; occluded(): whether anything occludes the rays. Rays end at the bounds of deferred procedurals.
    /// together: neighbouring rays are coherent.
    void intersect(std::span<const accel::Ray>, std::span<accel::Hit>, bool together = false);
    /// The nearest hit of one ray; false: none.
    bool intersect(const accel::Ray&, accel::Hit&);
    /// Nearest hits among the shapes that do not block all light, WorldImpl::byOpacity().few. Rays and hits use its numbers.
    void intersectFew(std::span<const accel::Ray>, std::span<accel::Hit>);
    /// Whether each ray is blocked by a shape that blocks all light: 1 or 0.
    void occluded(std::span<const accel::Ray>, std::span<uint8_t>);
    /// Transmittance of shadow rays whose answer is available in rows of 16: 1 if unoccluded, else 0. Returns false, without
    /// effect, if these rays need more.
    bool blockInRows(std::span<const ShadowRay>, std::span<Color> out);
    /// Fills `hits` for the rays of a slice.
    void cast(std::span<const Sched::Task>);
    accel::Ray rayOf(const PathRay&) const; ///< as the acceleration structure expects it
    void clip(accel::Ray&) const;           ///< restricts a camera ray to the clipping planes
    /// Call before the first slice of a call. grids: some rays have given hits.
    void begin(bool grids);

    std::vector<accel::Hit> hits; ///< by ray of the slice
    /// A ray reached the bound of a deferred procedural (DeferredBounds) since this was reset; the results are undefined.
    bool unfinished = false;

private:
    bool castRows(std::span<const Sched::Task>);
    std::vector<accel::Ray> rays_;
    std::vector<accel::Hit> found_;
    std::vector<uint32_t> given_; ///< rays of the slice whose hits are given
    bool inRows_ = false;         ///< accel::Accel::takesRows()
    bool grids_ = false;
};

} // namespace alpenglow::integrator

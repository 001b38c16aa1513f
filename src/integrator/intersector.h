// Intersect: what rays meet. Reads PathRay; writes a hit for each. Small scenes are searched in rows of 16 rays, the others ray
// by ray, camera rays together. Costs 30 to 500 ns a ray (bench/RESULTS.md).
#pragma once
#include "integrator/context.h"

namespace alpenglow::transport {

struct StageSet;

class Intersector final : Stage {
public:
    explicit Intersector(const StageSet&);
    /// What rays meet, or whether anything is in their way. At the bound of a procedural that is not made they end.
    /// together: neighbours go the same way.
    void meet(std::span<const accel::Ray>, std::span<accel::Hit>, bool together = false);
    bool meet(const accel::Ray&, accel::Hit&);
    /// The same of shapes that do not block all light alone, WorldImpl::byOpacity_.few. Rays and hits have its numbers.
    void meetFew(std::span<const accel::Ray>, std::span<accel::Hit>);
    void block(std::span<const accel::Ray>, std::span<uint8_t>);
    /// What shadow rays meet, where rows hold all that the rays need: 1 where nothing is in the way, else 0. False: they do not,
    /// and nothing was done.
    bool blockInRows(std::span<const ShadowRay>, std::span<Color> out);
    /// Writes `hits` for the rays of a slice.
    void cast(std::span<const Sched::Task>);
    accel::Ray rayOf(const PathRay&) const; ///< as the tree follows it
    void clip(accel::Ray&) const;           ///< keeps a camera ray within the clipping planes
    /// Before the first slice of a call. grids: some ray meets a point that is given.
    void begin(bool grids);

    std::vector<accel::Hit> hits; ///< by ray of the slice
    /// Whether a ray came to the bound of a procedural that is not made yet (Unmade) since this was reset: results are void.
    bool unfinished = false;

private:
    bool castRows(std::span<const Sched::Task>);
    std::vector<accel::Ray> rays_;
    std::vector<accel::Hit> found_;
    std::vector<uint32_t> given_; ///< of a slice, the rays whose points are given
    bool inRows_ = false;         ///< accel::Accel::takesRows()
    bool grids_ = false;
};

} // namespace alpenglow::transport

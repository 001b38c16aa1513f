// Surface interaction: the surface at each hit, as far as its kernel reads it (world/pointneeds.cpp), in runs of one shape, and
// the points that kernels run at. Costs 20 to 200 ns a point.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::transport {

class RayStore;
struct StageSet;

class SurfacePoints final : Stage {
public:
    explicit SurfacePoints(const StageSet&);
    void placeSurfaces(BatchContext&); ///< BatchContext::surfaces
    void placePoints(BatchContext&);   ///< BatchContext::points
    /// The points of a batch in rows, for those who need them after all.
    void pointsOfRows(BatchContext&);
    /// Where a ray from a point of a batch in direction w starts.
    Vec3 leave(const BatchContext&, size_t point, const Vec3& w) const;

private:
    template <class To> void placeSurfaces(const BatchContext&, To);
    void completePoint(BatchContext&, size_t point);
    std::vector<geometry::HitRef> run_; ///< of one shape
    RayStore& store_;
};

} // namespace alpenglow::transport

// Surface interactions: computes at each hit what its kernel reads (world/pointneeds.cpp), in runs of one shape, and the points
// for kernels. Costs 20 to 200 ns a point.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"

namespace alpenglow::integrator {

class RayStore;
struct StageSet;

/// Computes the surface interactions of hits.
class SurfacePoints final : Stage {
public:
    explicit SurfacePoints(const StageSet&);
    void placeSurfaces(BatchContext&); ///< fills BatchContext::surfaces
    void placePoints(BatchContext&);   ///< fills BatchContext::points
    /// Makes the points of a batch in rows, for stages that need them.
    void pointsOfRows(BatchContext&);
    /// Origin of a ray that leaves a point of a batch in direction w, offset from the surface.
    Vec3 leave(const BatchContext&, size_t point, const Vec3& w) const;

private:
    template <class To> void placeSurfaces(const BatchContext&, To);
    void completePoint(BatchContext&, size_t point);
    std::vector<geometry::HitRef> run_; ///< hits of one shape
    RayStore& store_;
};

} // namespace alpenglow::integrator

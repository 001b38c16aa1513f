#include "integrator/surfacepoints.h"
#include "integrator/context.h"
#include "integrator/gridrays.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

SurfacePoints::SurfacePoints(const StageSet& s) : Stage(s.context), store_(s.store) {}

/// Computes the surface at each hit of a batch as far as its kernel reads it. to: destination for hit i.
template <class To> void SurfacePoints::placeSurfaces(const BatchContext& c, To to) {
    std::vector<geometry::HitRef>& run = run_; // hits of one shape
    for (size_t i = 0; i < c.hits.size();) {
        const uint32_t shape = c.hits[i].shape;
        run.clear();
        for (; i < c.hits.size() && c.hits[i].shape == shape; ++i)
            run.push_back({c.hits[i].prim, c.hits[i].b1, c.hits[i].b2, to(i), world_.shadesAtOpen() ? 0 : c.hits[i].time});
        world_.shapes()[shape]->points(run, world_.bindings()[size_t(world_.bindingOf()[shape])].pointNeeds);
    }
}

void SurfacePoints::placeSurfaces(BatchContext& c) {
    c.surfaces.resize(std::max(c.surfaces.size(), c.hits.size()));
    placeSurfaces(c, [&](size_t i) { return &c.surfaces[i]; });
}

/// Fills a batch with the points of its hits.
void SurfacePoints::placePoints(BatchContext& c) {
    const size_t n = c.hits.size();
    c.points.resize(n); // pointers into points and rays stay valid
    c.depths.clear();
    for (size_t i = 0; world_.shadesAtOpen() && world_.moves() && i < n; ++i)
        c.depths.push_back(c.rays[i].origin.z + c.rays[i].dir.z * float(c.hits[i].distance));
    placeSurfaces(c, [&](size_t i) { return &c.points[i].surface; });
    for (size_t i = 0; i < n; ++i) completePoint(c, i);
}

/// Completes a point whose surface is known. It may hold values of another point: all are overwritten.
void SurfacePoints::completePoint(BatchContext& c, size_t i) {
    const PathRay& r = c.rays[i];
    ShadePoint& p = c.points[i];
    p.ray = &r;
    p.Ci = p.Oi = p.Ps = p.Ns = p.viewI = Vec3();
    p.lit = nullptr;
    p.alpha = 0;
    p.shape = world_.shapes()[c.hits[i].shape].get();
    p.P = p.surface.P;
    p.N = p.surface.N;
    p.I = p.P - r.begin(); // RISpec: P - E, though rays start at the near plane, or behind surfaces that they passed
    p.E = r.camera() ? Vec3(0, 0, 0) : r.begin();
    p.shutter = p.surface.time = world_.shadesAtOpen() ? 0 : r.shutter();
    world_.setTime(p);
    p.dPdtime = world_.moves() ? world_.pointsVelocity(*p.shape, p.surface) : Vec3(0.f);
    if (r.extra >= 0) store_.fade(c.rays[i], length(p.P - r.origin));
    if (!world_.needs().footprints) return;
    const float rate = r.camera() ? world_.bindings()[size_t(c.bindings[i])].shadingRate : 1;
    const Vec2 steps = stepsAt(r, p.surface, rate);
    p.du = steps.x, p.dv = steps.y;
}

void SurfacePoints::pointsOfRows(BatchContext& c) {
    if (!c.points.empty()) return;
    c.points.resize(c.hits.size());
    for (size_t i = 0; i < c.points.size(); ++i) {
        c.points[i].surface = c.surfaces[i];
        completePoint(c, i);
    }
}

Vec3 SurfacePoints::leave(const BatchContext& c, size_t point, const Vec3& w) const {
    const ShadePoint& p = c.points[point];
    if (const float bias = world_.bindings()[size_t(c.bindings[point])].bias; bias > 0) return p.P + w * bias;
    return geometry::offsetOrigin(p.surface, w, p.P == p.surface.P ? 0 : length(p.P - p.surface.P));
}

} // namespace alpenglow::integrator

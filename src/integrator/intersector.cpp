// Stages intersection and surface interaction: rays of a slice are intersected; hits are queued by group (same program and
// lights) until they fill the lanes of its kernel; then their points are computed, emission is added, and the kernel runs.
#include "integrator/intersector.h"
#include "integrator/context.h"
#include "integrator/gridrays.h"
#include "integrator/rowshading.h"
#include "integrator/stageset.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::integrator {

Intersector::Intersector(const StageSet& s) : Stage(s.context) {}

void Intersector::clip(accel::Ray& ray) const {
    for (const auto& [point, normal] : world_.clippingPlanes()) {
        double height = dot(normal, Vec3d(ray.org) - point), climb = dot(normal, Vec3d(ray.dir)), t = -height / climb;
        if (climb > 0) ray.tfar = std::min(ray.tfar, float(std::max(t, 0.0)));
        else if (climb < 0) ray.tnear = std::max(ray.tnear, float(std::min(t, 1e37)));
        else if (height > 0) ray.tfar = 0; // parallel to the plane, on the clipped side
    }
}

/// A ray for the acceleration structure: within the clipping planes, with its visibility mask.
accel::Ray Intersector::rayOf(const PathRay& r) const {
    accel::Ray ray;
    ray.org = r.origin;
    ray.dir = r.dir;
    ray.tnear = 0;
    ray.tfar = r.maxDistance;
    if (r.camera()) clip(ray);
    ray.time = world_.shutterOf(r);
    ray.mask = visibilityBit(r.type());
    ray.excludeShape = ray.excludePrim = geometry::kNone;
    ray.sides = r.kind->set.sides;
    ray.only = r.kind->set.only;
    ray.level = r.sample->level;
    return ray;
}

bool Intersector::intersect(const accel::Ray& ray, accel::Hit& hit) {
    world_.accel().intersect(ray, hit);
    if (world_.deferred() && world_.deferred()->intersects(ray, hit.valid() ? hit.distance : INFINITY)) {
        unfinished = true;
        hit = {};
    }
    ++counters_.tests;
    counters_.hits += hit.valid();
    return hit.valid();
}

/// Calls f(first, count) for parts of n rays that take little time even if a ray hits a hundred thousand shapes, and checks
/// `stop` between them; after a stop the results are discarded.
template <class F> static void inParts(size_t n, const StopFlag* stop, F f) {
    constexpr size_t kPart = 512;
    for (size_t at = 0; at < n && !(stop && *stop); at += kPart) f(at, std::min(kPart, n - at));
}

void Intersector::intersect(std::span<const accel::Ray> rays, std::span<accel::Hit> found, bool together) {
    std::fill(found.begin(), found.end(), accel::Hit{});
    inParts(rays.size(), context_.stop, [&](size_t at, size_t n) {
        const auto some = rays.subspan(at, n);
        const auto met = found.subspan(at, n);
        if (together) world_.accel().intersectTogether(some, met, context_.stop);
        else world_.accel().intersect(some, met, context_.stop);
    });
    for (size_t i = 0; world_.deferred() && i < rays.size(); ++i) {
        if (!world_.deferred()->intersects(rays[i], found[i].valid() ? found[i].distance : INFINITY)) continue;
        unfinished = true;
        found[i] = {};
    }
    counters_.tests += rays.size();
    for (const accel::Hit& h : found) counters_.hits += h.valid();
}

void Intersector::intersectFew(std::span<const accel::Ray> rays, std::span<accel::Hit> found) {
    std::fill(found.begin(), found.end(), accel::Hit{});
    world_.byOpacity().few->intersect(rays, found, context_.stop);
    counters_.tests += rays.size();
    for (const accel::Hit& h : found) counters_.hits += h.valid();
}

void Intersector::occluded(std::span<const accel::Ray> rays, std::span<uint8_t> blocked) {
    std::fill(blocked.begin(), blocked.end(), uint8_t(0));
    inParts(rays.size(), context_.stop,
            [&](size_t at, size_t n) { world_.accel().occluded(rays.subspan(at, n), blocked.subspan(at, n), context_.stop); });
    for (size_t i = 0; world_.deferred() && i < rays.size(); ++i) {
        if (blocked[i] || !world_.deferred()->intersects(rays[i], INFINITY)) continue;
        unfinished = true;
        blocked[i] = 1;
    }
    counters_.tests += rays.size();
    for (uint8_t b : blocked) counters_.hits += b != 0;
}

void Intersector::begin(bool grids) {
    grids_ = grids;
    inRows_ = world_.accel().takesRows() && !world_.deferred() && world_.clippingPlanes().empty() && !world_.shadesAtOpen();
}

void Intersector::cast(std::span<const Sched::Task> slice) {
    if (castRows(slice)) return;
    rays_.clear();
    hits.resize(slice.size());
    given_.clear();
    for (size_t i = 0; i < slice.size(); ++i) {
        const PathRay& r = slice[i].payload;
        ++context_.raysOf(r.type());
        if (!beginsAtGrid(r)) rays_.push_back(rayOf(r));
        else given_.push_back(uint32_t(i));
    }
    const auto first = [](const Sched::Task& t) { return t.payload.camera() && t.payload.bounces == 0; };
    if (given_.empty()) return intersect(rays_, hits, std::all_of(slice.begin(), slice.end(), first));
    found_.resize(rays_.size());
    intersect(rays_, found_);
    size_t next = 0, met = 0;
    for (size_t i = 0; i < slice.size(); ++i) {
        if (next == given_.size() || given_[next] != i) {
            hits[i] = found_[met++];
            continue;
        }
        const PathRay& r = slice[given_[next++]].payload;
        const shading::GridPoint& g = *r.sample->grid;
        hits[i] = {g.distance, g.shape, g.prim, world_.shutterOf(r), g.b1, g.b2, g.distance};
    }
}

} // namespace alpenglow::integrator

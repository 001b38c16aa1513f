// Stages meet and settle: a slice of rays meets surfaces; hits wait by group (same program and lights) until enough of them are
// there to fill the lanes of its kernel; then their points are worked out, emitters among them shine, and the kernel runs.
#include "integrator/gridrays.h"
#include "integrator/rowshading.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::transport {

namespace {
constexpr size_t kBatchPoints = 256;  ///< hits of a group that are shaded without waiting for more
constexpr size_t kWaitingHits = 4096; ///< of all groups, at most: their memory stays in the cache of a core
} // namespace

void Engine::follow(std::span<const Sched::Task> slice, Sched& sched) {
    if (!castRows(slice)) cast(slice);
    std::vector<const Sched::Task*> missed;
    if (hitQueues_.empty()) hitQueues_.resize(size_t(world_->groups_) * (world_->primitiveHit_ ? 2 : 1));
    for (size_t i = 0; i < slice.size(); ++i) {
        if (!hits_[i].valid()) missed.push_back(&slice[i]);
        else queueHit(slice[i], hits_[i], sched);
    }
    fly(missed, sched);
    misses(missed, sched);
    for (const Sched::Task* t : missed) freeExtra(t->payload);
    // While kernels wait for rays nothing is held back: depth before breadth keeps their frames few.
    const bool all = sched.frameBytes() > 0 || raysAtOnce_ < kSliceOfPath;
    const std::vector<size_t> groups = groupsWithHits_;
    for (size_t g : groups)
        if (all || hitQueues_[g].waits || hitQueues_[g].hits.size() >= kBatchPoints) shadeHits(g, sched);
    while (hitsWaiting_ > kWaitingHits) settle(sched);
}

bool Engine::settle(Sched& sched) {
    if (groupsWithHits_.empty()) return false;
    const auto fewer = [&](size_t a, size_t b) { return hitQueues_[a].hits.size() < hitQueues_[b].hits.size(); };
    shadeHits(*std::max_element(groupsWithHits_.begin(), groupsWithHits_.end(), fewer), sched);
    return true;
}

void Engine::clip(accel::Ray& ray) const {
    for (const auto& [point, normal] : world_->clippingPlanes_) {
        double height = dot(normal, Vec3d(ray.org) - point), climb = dot(normal, Vec3d(ray.dir)), t = -height / climb;
        if (climb > 0) ray.tfar = std::min(ray.tfar, float(std::max(t, 0.0)));
        else if (climb < 0) ray.tnear = std::max(ray.tnear, float(std::min(t, 1e37)));
        else if (height > 0) ray.tfar = 0; // along the plane, on its cut side
    }
}

float Engine::levelOfSample(const CameraRay& c) const {
    return Random(render::SampleNumbers(render::Sampler(seed_, c.px, c.py), c.sample)).one(0, kLevel, 0);
}

/// A ray as the tree follows it: within the clipping planes, meeting what it may meet.
accel::Ray Engine::rayOf(const PathRay& r) const {
    accel::Ray ray;
    ray.org = r.origin;
    ray.dir = r.dir;
    ray.tnear = 0;
    ray.tfar = r.maxDistance;
    if (r.camera()) clip(ray);
    ray.time = world_->shutterOf(r);
    ray.mask = visibilityBit(r.type());
    ray.excludeShape = ray.excludePrim = geometry::kNone;
    ray.sides = r.kind->set.sides;
    ray.only = r.kind->set.only;
    ray.level = r.sample->level;
    return ray;
}

bool Engine::meet(const accel::Ray& ray, accel::Hit& hit) {
    world_->accel_->intersect(ray, hit);
    if (world_->unmade_ && world_->unmade_->meets(ray, hit.valid() ? hit.distance : INFINITY)) {
        unfinished_ = true;
        hit = {};
    }
    ++counters.tests;
    counters.hits += hit.valid();
    return hit.valid();
}

/// Calls f(first, count) for parts of n rays that take little time even where a ray meets a hundred thousand shapes. Who stops
/// throws the rest away, whatever it is.
template <class F> static void inParts(size_t n, const StopFlag* stop, F f) {
    constexpr size_t kPart = 512;
    for (size_t at = 0; at < n && !(stop && *stop); at += kPart) f(at, std::min(kPart, n - at));
}

void Engine::meet(std::span<const accel::Ray> rays, std::span<accel::Hit> hits, bool together) {
    std::fill(hits.begin(), hits.end(), accel::Hit{});
    inParts(rays.size(), stop, [&](size_t at, size_t n) {
        const auto some = rays.subspan(at, n);
        const auto met = hits.subspan(at, n);
        if (together) world_->accel_->intersectTogether(some, met, stop);
        else world_->accel_->intersect(some, met, stop);
    });
    for (size_t i = 0; world_->unmade_ && i < rays.size(); ++i) {
        if (!world_->unmade_->meets(rays[i], hits[i].valid() ? hits[i].distance : INFINITY)) continue;
        unfinished_ = true;
        hits[i] = {};
    }
    counters.tests += rays.size();
    for (const accel::Hit& h : hits) counters.hits += h.valid();
}

void Engine::block(std::span<const accel::Ray> rays, std::span<uint8_t> blocked) {
    std::fill(blocked.begin(), blocked.end(), uint8_t(0));
    inParts(rays.size(), stop,
            [&](size_t at, size_t n) { world_->accel_->occluded(rays.subspan(at, n), blocked.subspan(at, n), stop); });
    for (size_t i = 0; world_->unmade_ && i < rays.size(); ++i) {
        if (blocked[i] || !world_->unmade_->meets(rays[i], INFINITY)) continue;
        unfinished_ = true;
        blocked[i] = 1;
    }
    counters.tests += rays.size();
    for (uint8_t b : blocked) counters.hits += b != 0;
}

/// What the rays of a slice meet: hits_.
void Engine::cast(std::span<const Sched::Task> slice) {
    rays_.clear();
    hits_.resize(slice.size());
    given_.clear();
    for (size_t i = 0; i < slice.size(); ++i) {
        const PathRay& r = slice[i].payload;
        ++raysOf(r.type());
        if (!beginsAtGrid(r)) rays_.push_back(rayOf(r));
        else given_.push_back(uint32_t(i));
    }
    const auto first = [](const Sched::Task& t) { return t.payload.camera() && t.payload.bounces == 0; };
    if (given_.empty()) return meet(rays_, hits_, std::all_of(slice.begin(), slice.end(), first));
    found_.resize(rays_.size());
    meet(rays_, found_);
    size_t next = 0, met = 0;
    for (size_t i = 0; i < slice.size(); ++i) {
        if (next == given_.size() || given_[next] != i) {
            hits_[i] = found_[met++];
            continue;
        }
        const PathRay& r = slice[given_[next++]].payload;
        const shading::GridPoint& g = *r.sample->grid;
        hits_[i] = {g.distance, g.shape, g.prim, world_->shutterOf(r), g.b1, g.b2, g.distance};
    }
}

/// Points by program and light list. Those of rays that take primitives as they are have groups behind the others.
void Engine::queueHit(const Sched::Task& task, const accel::Hit& hit, Sched& sched) {
    const PathRay& r = task.payload;
    const SurfaceBinding& b = world_->bindings_[size_t(world_->bindingOf_[hit.shape])];
    const bool primitive = world_->primitiveHit_ && b.asPrimitive(r.kind->set.mode, r.type());
    const size_t g = size_t(b.group) + (primitive ? size_t(world_->groups_) : 0);
    HitQueue& q = hitQueues_[g];
    if (q.hits.empty()) {
        const rsl::CompiledKernel& k = *(primitive ? world_->primitiveHit_ : b.surfaceS).kernel;
        q.waits = k.facts().suspends;
        if (q.waits) q.room = size_t(roomFor(k, primitive ? nullptr : b.surfaceV.kernel.get(), sched));
        groupsWithHits_.push_back(g);
    } else if (q.waits && q.hits.size() >= q.room) {
        // Of a kernel that waits no more points are shaded than its frames have room for: the others are followed again, later.
        --raysOf(r.type());
        sched.spawn(task);
        return;
    }
    q.hits.push_back(hit);
    q.rays.push_back(r);
    q.targets.push_back(task.target);
    sched.hold(task.target);
    ++hitsWaiting_;
}

int Engine::roomFor(const rsl::CompiledKernel& k, const rsl::CompiledKernel* other, const Sched& sched) const {
    size_t frame = 0;
    for (const rsl::CompiledKernel* one : {&k, other})
        if (const auto known = frameOf_.find(one); known != frameOf_.end()) frame = std::max(frame, known->second);
    if (frame == 0) return k.lanes(); // the first strip tells
    const size_t most = sched.frameLimit() / 4, left = most - std::min(most, sched.frameBytes());
    return int(std::clamp<size_t>(left / frame, 1, size_t(limits::kSliceRays))) * k.lanes();
}

void Engine::shadeHits(size_t group, Sched& sched) {
    std::erase(groupsWithHits_, group);
    hitsWaiting_ -= hitQueues_[group].hits.size();
    auto c = takeContext();
    c->engine = this;
    c->ownsExtras = true;
    takeHits(hitQueues_[group], *c);
    if (rows_->takes(group) && rows_->shade(*c, sched)) return finishBatch(std::move(c), sched);
    placePoints(*c);
    fly(*c, sched);
    if (c->rays.empty()) return giveBack(std::move(c));
    shine(*c, sched);
    keepIndirect(*c);
    if (world_->globalMaps_) takeGlobalMaps(*c, sched);
    if (c->rays.empty()) return giveBack(std::move(c));
    if (photonTrace_) tiltPhotons(*c);
    const bool same = std::all_of(c->bindings.begin(), c->bindings.end(), [&](int b) { return b == c->bindings[0]; });
    c->binding = &world_->bindings_[size_t(c->bindings[0])];
    c->bound = group >= size_t(world_->groups_)       ? &world_->primitiveHit_
               : same && !c->binding->usesObjectSpace ? &c->binding->surfaceS
                                                      : &c->binding->surfaceV;
    shadeGroup(c, sched);
    finishBatch(std::move(c), sched);
}

void Engine::finishBatch(std::shared_ptr<BatchContext> c, Sched& sched) {
    for (size_t i = 0; i < c->targets.size() && !sched.plain(); ++i) sched.release(c->targets[i]);
    giveBack(std::move(c));
}

/// Moves waiting hits, with their rays, to a batch.
void Engine::takeHits(HitQueue& q, BatchContext& c) {
    c.rays.swap(q.rays);
    c.targets.swap(q.targets);
    c.hits.swap(q.hits);
    for (const accel::Hit& h : c.hits) c.bindings.push_back(world_->bindingOf_[h.shape]);
}

/// The surface at each hit of a batch, as far as its kernel reads it. to: where that of hit i is written.
template <class To> void Engine::placeSurfaces(const BatchContext& c, To to) {
    std::vector<geometry::HitRef>& run = run_; // of one shape
    for (size_t i = 0; i < c.hits.size();) {
        const uint32_t shape = c.hits[i].shape;
        run.clear();
        for (; i < c.hits.size() && c.hits[i].shape == shape; ++i)
            run.push_back({c.hits[i].prim, c.hits[i].b1, c.hits[i].b2, to(i), world_->shadesAtOpen_ ? 0 : c.hits[i].time});
        world_->shapes_[shape]->points(run, world_->bindings_[size_t(world_->bindingOf_[shape])].pointNeeds);
    }
}

void Engine::placeSurfaces(BatchContext& c) {
    c.surfaces.resize(std::max(c.surfaces.size(), c.hits.size()));
    placeSurfaces(c, [&](size_t i) { return &c.surfaces[i]; });
}

/// Fills a context with the points of its hits.
void Engine::placePoints(BatchContext& c) {
    const size_t n = c.hits.size();
    c.points.resize(n); // pointers into points and rays stay good
    c.depths.clear();
    for (size_t i = 0; world_->shadesAtOpen_ && world_->moves_ && i < n; ++i)
        c.depths.push_back(c.rays[i].origin.z + c.rays[i].dir.z * float(c.hits[i].distance));
    placeSurfaces(c, [&](size_t i) { return &c.points[i].surface; });
    for (size_t i = 0; i < n; ++i) completePoint(c, i);
}

/// A point whose surface is known. It may hold another point's numbers: all of it is written.
void Engine::completePoint(BatchContext& c, size_t i) {
    const PathRay& r = c.rays[i];
    ShadePoint& p = c.points[i];
    p.ray = &r;
    p.Ci = p.Oi = p.Ps = p.Ns = p.viewI = Vec3();
    p.lit = nullptr;
    p.alpha = 0;
    p.shape = world_->shapes_[c.hits[i].shape].get();
    p.P = p.surface.P;
    p.N = p.surface.N;
    p.I = p.P - r.begin(); // RISpec: P - E, though rays start at the near plane, or behind what they passed through
    p.E = r.camera() ? Vec3(0, 0, 0) : r.begin();
    p.shutter = p.surface.time = world_->shadesAtOpen_ ? 0 : r.shutter();
    world_->tellTime(p);
    p.dPdtime = world_->moves_ ? world_->pointsVelocity(*p.shape, p.surface) : Vec3(0.f);
    if (r.extra >= 0) fade(c.rays[i], length(p.P - r.origin));
    if (!world_->footprints_) return;
    const float rate = r.camera() ? world_->bindings_[size_t(c.bindings[i])].shadingRate : 1;
    const Vec2 steps = stepsAt(r, p.surface, rate);
    p.du = steps.x, p.dv = steps.y;
}

void Engine::pointsOfRows(BatchContext& c) {
    if (!c.points.empty()) return;
    c.points.resize(c.hits.size());
    for (size_t i = 0; i < c.points.size(); ++i) {
        c.points[i].surface = c.surfaces[i];
        completePoint(c, i);
    }
}

/// What a ray meets counts less far away, where its call says so.
void Engine::fade(PathRay& r, float way) {
    RayExtra& x = extras_[size_t(r.extra)];
    if (!x.fade.fades()) return;
    x.whole = r.weight;
    x.kept = x.fade.at(double(x.way) + way);
    r.weight *= x.kept;
}

/// From here on what a ray brings is of surfaces: the light of emitters is in its target.
void Engine::keepIndirect(BatchContext& c) {
    if (std::exchange(c.indirectKept, true)) return;
    for (PathRay& r : c.rays) {
        if (r.extra < 0) continue;
        RayExtra& x = extras_[size_t(r.extra)];
        if (x.indirect == 1) continue;
        if (!x.fade.fades()) x.whole = r.weight;
        r.weight *= x.indirect;
    }
}

/// Light of the emitters among the points.
void Engine::shine(const BatchContext& c, Sched& sched) {
    std::vector<Met> met;
    for (size_t i = 0; i < c.points.size(); ++i) {
        const SurfaceBinding& b = world_->bindings_[size_t(c.bindings[i])];
        const PathRay& r = c.rays[i];
        if (b.areaLight < 0 || (b.matte && r.camera())) continue;
        if (!rules_.emissionCounts && r.lobePdf < 0 && !r.kind->asksLights) continue;
        if (r.lobeBinding >=
            0) { // a lobe that samples lights: those that are off for its surface do not light it by chance either
            if (!world_->bindings_[size_t(r.lobeBinding)].lights.contains(b.areaLight)) continue;
        }
        const BoundLight& light = world_->lights_[size_t(b.areaLight)];
        if (light.mean || !light.seenBy(*r.kind)) continue;
        met.push_back({b.areaLight, c.targets[i], &c.points[i]});
        for (int part : light.parts)
            if (world_->lights_[size_t(part)].kind == LightKind::Area) met.push_back({part, c.targets[i], &c.points[i]});
    }
    std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.light < b.light; });
    emission(met, sched);
}

} // namespace alpenglow::transport

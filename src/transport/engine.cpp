// Following a slice of rays: intersect, group by shader, shade, hand on.
#include "transport/gather.h"
#include "base/memory.h"
#include <algorithm>
#include <limits>

namespace alpenglow::transport {

void Counters::operator+=(const Counters& o) {
    camera += o.camera; diffuse += o.diffuse; specular += o.specular; transmission += o.transmission; shadow += o.shadow;
    points += o.points; batches += o.batches; lanesUsed += o.lanesUsed; lanesRun += o.lanesRun;
    nonFinite += o.nonFinite; overLimit += o.overLimit; depthCap += o.depthCap;
    depthSum += o.depthSum; paths += o.paths;
    depthMax = std::max(depthMax, o.depthMax);
    peakFrameBytes = std::max(peakFrameBytes, o.peakFrameBytes);
}

Engine::Engine(std::shared_ptr<const WorldImpl> w, Diagnostics& d)
    : world_(std::move(w)), diagnostics_(d), seed_(world_->settings_.seed), rules_(world_->settings_) {
    noSample_.numbers = render::SampleNumbers(render::Sampler(seed_, 0, 0), 0);
}

Engine::~Engine() { // strips of a frame that was given up need their kernels
    inner_.reset();
    sched_.reset();
}

void Engine::follow(std::span<const Sched::Task> slice, Sched& sched) {
    size_t n = slice.size();
    std::vector<accel::Ray>& rays = rays_;
    std::vector<accel::Hit>& hits = hits_;
    rays.resize(n); // each is written whole
    hits.resize(n);
    for (size_t i = 0; i < n; ++i) {
        const PathRay& r = slice[i].payload;
        rays[i].org = r.origin;
        rays[i].dir = r.dir;
        rays[i].tnear = 0;
        rays[i].tfar = r.maxDistance;
        if (r.camera())
            for (const auto& [point, normal] : world_->clippingPlanes_) {
                double height = dot(normal, Vec3d(r.origin) - point), climb = dot(normal, Vec3d(r.dir)), t = -height / climb;
                if (climb > 0) rays[i].tfar = std::min(rays[i].tfar, float(std::max(t, 0.0)));
                else if (climb < 0) rays[i].tnear = std::max(rays[i].tnear, float(std::min(t, 1e37)));
                else if (height > 0) rays[i].tfar = 0; // along the plane, on its cut side
            }
        rays[i].time = r.time();
        rays[i].mask = visibilityBit(r.type());
        rays[i].excludeShape = rays[i].excludePrim = geometry::kNone;
        rays[i].sides = r.kind->set.sides;
        rays[i].only = r.kind->set.only;
        rays[i].level = r.sample->level;
        ++raysOf(r.type());
    }
    world_->accel_->intersect(rays, hits);

    // Points by program and light list; inside a group in the order of the slice.
    // Those of rays that take primitives as they are come behind the others.
    const size_t shaded = size_t(world_->groups_);
    std::vector<std::shared_ptr<BatchContext>> groups(shaded * (world_->primitiveHit_ ? 2 : 1));
    std::vector<int> sizes(groups.size());
    const auto groupOf = [&](const SurfaceBinding& b, const PathRay& r) { return size_t(b.group) + (groups.size() > shaded && b.asPrimitive(r.kind->set.mode, r.type()) ? shaded : 0); };
    const std::vector<char> later = putBack(slice, sizes, groupOf, sched);
    for (size_t g = 0; g < groups.size(); ++g) {
        if (!sizes[g]) continue;
        auto& c = groups[g] = takeContext();
        c->engine = this;
        c->ownsExtras = true;
        c->points.resize(size_t(sizes[g])); // pointers into points and rays stay good
        c->rays.reserve(size_t(sizes[g]));
        c->targets.reserve(size_t(sizes[g]));
        c->bindings.reserve(size_t(sizes[g]));
    }
    std::vector<Met> met;
    std::vector<const Sched::Task*> missed;
    std::vector<ShadePoint*>& places = places_; // by hit; null: none that is shaded now
    places.assign(n, nullptr);
    for (size_t i = 0; i < n; ++i) {
        if (!hits[i].valid()) { missed.push_back(&slice[i]); continue; }
        if (later[i]) continue;
        const PathRay& r = slice[i].payload;
        int binding = world_->bindingOf_[hits[i].shape];
        const SurfaceBinding& b = world_->bindings_[size_t(binding)];
        BatchContext& c = *groups[groupOf(b, r)];
        c.rays.push_back(r);
        c.targets.push_back(slice[i].target);
        c.bindings.push_back(binding);
        ShadePoint& p = c.points[c.rays.size() - 1]; // may hold another point's numbers: all of it is written
        p.ray = &c.rays.back();
        p.Ci = p.Oi = p.Ps = p.Ns = p.viewI = Vec3();
        p.lit = nullptr;
        p.alpha = 0;
        p.shape = world_->shapes_[hits[i].shape].get();
        places[i] = &p;
    }
    evaluateHits(places);
    for (size_t i = 0; i < n; ++i) {
        if (!places[i]) continue;
        ShadePoint& p = *places[i];
        const PathRay& r = *p.ray;
        const SurfaceBinding& b = world_->bindings_[size_t(world_->bindingOf_[hits[i].shape])];
        p.P = p.surface.P;
        p.N = p.surface.N;
        p.I = p.P - r.begin(); // RISpec: P - E, though rays start at the near plane, or behind what they passed through
        p.E = r.camera() ? Vec3(0, 0, 0) : r.origin;
        p.time = r.time();
        if (world_->footprints_) shading::setFootprint(p, r.footprint, r.dir, length(p.P - r.origin), r.camera() ? b.shadingRate : 1);
        if (b.areaLight < 0 || (b.matte && r.camera())) continue;
        if (!rules_.emissionCounts && r.lobePdf < 0) continue;
        if (r.lobeBinding >= 0) { // a lobe that samples lights: those that are off for its surface do not light it by chance either
            const auto& on = world_->bindings_[size_t(r.lobeBinding)].lights;
            if (std::find(on.begin(), on.end(), b.areaLight) == on.end()) continue;
        }
        const BoundLight& light = world_->lights_[size_t(b.areaLight)];
        if (light.mean || (r.kind->fromTrace && light.strategy == LightStrategy::Illuminance)) continue;
        met.push_back({b.areaLight, slice[i].target, &p});
        for (int part : light.parts)
            if (world_->lights_[size_t(part)].kind == LightKind::Area) met.push_back({part, slice[i].target, &p});
    }
    misses(missed, sched);
    for (const Sched::Task* t : missed) freeExtra(t->payload);
    std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.light < b.light; });
    emission(met, sched);
    for (size_t g = 0; g < groups.size(); ++g) {
        auto& c = groups[g];
        if (!c) continue;
        bool same = std::all_of(c->bindings.begin(), c->bindings.end(), [&](int b) { return b == c->bindings[0]; });
        c->binding = &world_->bindings_[size_t(c->bindings[0])];
        c->bound = g >= shaded ? &world_->primitiveHit_ : same && !c->binding->usesObjectSpace ? &c->binding->surfaceS : &c->binding->surfaceV;
        shadeGroup(c, sched);
        giveBack(std::move(c));
    }
}

const RayKind* Engine::kindOf(const RayKind& k) {
    if (lastKind_ && *lastKind_ == k) return lastKind_;
    const uint64_t what = uint64_t(uint32_t(k.label)) << 32 | uint64_t(k.type) << 16 | uint64_t(k.fromTrace) << 12 |
                          uint64_t(k.set.sides) << 8 | uint64_t(k.set.mode);
    std::deque<RayKind>& known = kinds_[render::mix64(what ^ render::mix64(reinterpret_cast<uintptr_t>(k.set.only)))];
    auto found = std::find(known.begin(), known.end(), k);
    if (found == known.end()) found = known.insert(known.end(), k);
    return lastKind_ = &*found;
}

int32_t Engine::newExtra(const RayExtra& e) {
    if (e == noExtra_) return -1;
    if (freeExtras_.empty()) {
        extras_.push_back(e);
        return int32_t(extras_.size()) - 1;
    }
    const int32_t at = freeExtras_.back();
    freeExtras_.pop_back();
    extras_[size_t(at)] = e;
    return at;
}

void Engine::freeExtras(BatchContext& c) {
    if (!std::exchange(c.ownsExtras, false)) return;
    for (const PathRay& r : c.rays) freeExtra(r);
}

BatchContext::~BatchContext() {
    if (ownsExtras) engine->freeExtras(*this);
}

void Engine::evaluateHits(std::span<ShadePoint* const> places) {
    std::vector<geometry::HitRef>& run = run_;
    for (size_t i = 0; i < places.size();) {
        const uint32_t shape = hits_[i].shape;
        run.clear();
        for (; i < places.size() && (!places[i] || hits_[i].shape == shape); ++i)
            if (places[i]) run.push_back({hits_[i].prim, hits_[i].b1, hits_[i].b2, &places[i]->surface});
        if (!run.empty()) world_->shapes_[shape]->points(run, world_->bindings_[size_t(world_->bindingOf_[shape])].pointNeeds);
    }
}

uint64_t& Engine::raysOf(RayType t) {
    switch (t) {
    case RayType::Camera: return counters.camera;
    case RayType::Diffuse: return counters.diffuse;
    case RayType::Specular: return counters.specular;
    default: return counters.transmission;
    }
}

std::vector<char> Engine::putBack(std::span<const Sched::Task> slice, std::span<int> sizes, const GroupOf& groupOf,
                                  Sched& sched) {
    std::vector<int> room(sizes.size(), -1); // by group; -1: not asked yet
    std::vector<char> later(slice.size());
    for (size_t i = 0; i < slice.size(); ++i) {
        if (!hits_[i].valid()) continue;
        const PathRay& r = slice[i].payload;
        const SurfaceBinding& b = world_->bindings_[size_t(world_->bindingOf_[hits_[i].shape])];
        const size_t g = groupOf(b, r);
        const BoundKernel& k = world_->primitiveHit_ && b.asPrimitive(r.kind->set.mode, r.type()) ? world_->primitiveHit_ : b.surfaceS;
        if (k.kernel->facts().suspends) {
            if (room[g] < 0) room[g] = roomFor(*k.kernel, &k == &b.surfaceS ? b.surfaceV.kernel.get() : nullptr, sched);
            if (sizes[g] >= room[g]) {
                later[i] = 1;
                --raysOf(r.type());
                sched.spawn(slice[i]);
                continue;
            }
        }
        ++sizes[g];
    }
    return later;
}

int Engine::roomFor(const rsl::CompiledKernel& k, const rsl::CompiledKernel* other, const Sched& sched) const {
    size_t frame = 0;
    for (const rsl::CompiledKernel* one : {&k, other})
        if (const auto known = frameOf_.find(one); known != frameOf_.end()) frame = std::max(frame, known->second);
    if (frame == 0) return k.lanes(); // the first strip tells
    const size_t most = sched.frameLimit() / 4, left = most - std::min(most, sched.frameBytes());
    return int(std::clamp<size_t>(left / frame, 1, size_t(limits::kSliceRays))) * k.lanes();
}

std::shared_ptr<BatchContext> Engine::takeContext() {
    if (pool_.empty()) return std::make_shared<BatchContext>();
    auto c = std::move(pool_.back());
    pool_.pop_back();
    return c;
}

void Engine::giveBack(std::shared_ptr<BatchContext> c) {
    if (c.use_count() != 1) return; // a strip waits in it
    if (c->batch.use_count() != 1) c->batch.reset();
    c->bound = nullptr;
    c->binding = nullptr;
    freeExtras(*c);
    c->rays.clear(); // points stay: follow() writes them again
    c->targets.clear();
    c->bindings.clear();
    c->emits.clear();
    c->emitted = 0;
    c->failure = nullptr;
    c->arena.clear();
    c->haze.clear();
    c->clear.clear();
    c->passes.clear();
    c->lightDistance.clear();
    c->lightChannels.clear();
    c->draws.clear();
    c->requestSite = -1;
    for (LightLoop& loop : c->loops) loop.reset(-1);
    c->ambient.clear();
    for (LightSheet& sheet : c->sheets) sheet.made = sheet.refused = false;
    c->lit = nullptr;
    c->displaced.reset();
    c->light = nullptr;
    c->aside = nullptr;
    c->volume = nullptr;
    c->lightVisibilityDistance = 0;
    pool_.push_back(std::move(c));
}

bool Engine::trace(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stopFlag) {
    const Counters before = counters;
    while (true) {
        beginsAnew_ = raysAtOnce_ > 1;
        try {
            const bool done = traceAll(rays, out, stopFlag);
            beginsAnew_ = false;
            return done;
        } catch (const LimitReached&) { // results do not depend on how many points are shaded at a time
            if (!std::exchange(beginsAnew_, false)) throw;
        }
        counters = before;
        raysAtOnce_ = std::max(1, raysAtOnce_ / 8);
        inner_.reset();
        sched_.reset(); // strips that wait give back what is forgotten then
        forget();
    }
}

void Engine::forget() {
    lobes.clear();
    lobeRows_.clear();
    shadows.clear();
    traceSums_.clear();
    litValues_.clear();
    waiting_.clear();
    extras_.clear();
    freeExtras_.clear();
}

bool Engine::traceAll(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stopFlag) {
    stop = stopFlag;
    if (!sched_) sched_ = std::make_unique<Sched>(*this, stopFlag, limits::kFrameBytesPerThread, raysAtOnce_);
    Sched& sched = *sched_;
    sched.restart(stopFlag);
    size_t aovs = 0;
    for (int w : world_->outputWidths_) aovs += size_t(w);
    results.resize(rays.size());
    samples_.resize(rays.size());
    std::vector<TargetId> roots(rays.size());
    lightTargets_.clear();
    shares_.clear();
    nowhere_ = world_->lightOutputs_.empty() ? shading::kNoTarget : sched.newRoot();
    for (size_t i = 0; i < rays.size(); ++i) {
        const CameraRay& c = rays[i];
        out[i] = SampleResult{};
        out[i].aovs.assign(aovs, 0.f);
        results[i] = &out[i];
        roots[i] = sched.newRoot();
        for (size_t k = 0; k < world_->lightOutputs_.size(); ++k) lightTargets_.push_back(sched.newRoot());
        PathRay& r = sched.spawn(0, roots[i]).payload;
        r.origin = c.origin;
        r.dir = c.direction;
        PathSample& sample = samples_[i];
        sample = {c.px, c.py, c.sample, int(i), c.time, 0.5f, render::SampleNumbers(render::Sampler(seed_, c.px, c.py), c.sample)};
        r.sample = &sample;
        r.footprint = {c.width, c.spread};
        r.setStart(c.start);
        r.media = world_->eye_.count ? &world_->eye_ : nullptr;
        if (world_->fades_) sample.level = random(r).one(0, kLevel, 0);
        r.counts = true;
    }
    counters.paths += rays.size();
    spoiled_.clear();
    waiting_.clear();
    bool done = sched.run();
    float clampAt = world_->settings_.sampleClamp;
    for (size_t i = 0; i < rays.size(); ++i) {
        Color c = sched.value(roots[i]).radiance;
        float m = maxComponent(c);
        if (clampAt > 0 && m > clampAt) c *= clampAt / m; // pathtracer.md 6
        out[i].color = c;
        for (size_t k = 0; k < world_->lightOutputs_.size(); ++k) {
            const LightOutputPlace& to = world_->lightOutputs_[k];
            if (to.first < 0) continue;
            const Color light = sched.value(lightTargets_[i * world_->lightOutputs_.size() + k]).radiance;
            if (to.size == 1) out[i].aovs[size_t(to.first)] += light.x + light.y + light.z;
            else
                for (int n = 0; n < 3; ++n) out[i].aovs[size_t(to.first + n)] += light[n];
        }
        Color& o = out[i].opacity;
        o = {std::min(o.x, 1.f), std::min(o.y, 1.f), std::min(o.z, 1.f)};
    }
    for (int i : spoiled_) out[size_t(i)].color = Color(std::numeric_limits<float>::quiet_NaN());
    counters.nonFinite += sched.nonFinite();
    counters.overLimit += sched.overLimit();
    counters.peakFrameBytes = std::max(counters.peakFrameBytes, sched.peakFrameBytes());
    forget();
    return done;
}

struct Integrator::Impl {
    Engine engine;
    Impl(std::shared_ptr<const WorldImpl> w, Diagnostics& d) : engine(std::move(w), d) {}
};
Integrator::Integrator(std::shared_ptr<const World> w, Diagnostics& d)
    : impl_(std::make_unique<Impl>(std::static_pointer_cast<const WorldImpl>(std::move(w)), d)) {}
Integrator::~Integrator() = default;
bool Integrator::trace(std::span<const CameraRay> r, std::span<SampleResult> out, const StopFlag* stop) {
    return impl_->engine.trace(r, out, stop);
}
const Counters& Integrator::counters() const { return impl_->engine.counters; }

} // namespace alpenglow::transport

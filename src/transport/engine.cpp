// Following a slice of rays: intersect, group by shader, shade, hand on.
#include "transport/engine.h"
#include "transport/sampling.h"
#include <algorithm>
#include <array>

namespace alpenglow::transport {

void Counters::operator+=(const Counters& o) {
    camera += o.camera; diffuse += o.diffuse; specular += o.specular; transmission += o.transmission; shadow += o.shadow;
    points += o.points; batches += o.batches; lanesUsed += o.lanesUsed; lanesRun += o.lanesRun;
    nonFinite += o.nonFinite; overLimit += o.overLimit; depthCap += o.depthCap;
    depthSum += o.depthSum; paths += o.paths;
    depthMax = std::max(depthMax, o.depthMax);
    peakFrameBytes = std::max(peakFrameBytes, o.peakFrameBytes);
}

namespace {

// trace() and transmission() always ask for rays; the lobe shadeops only where the engine estimates them.
bool isRequest(SiteKind k, bool path) {
    return k == SiteKind::Trace || k == SiteKind::Transmission || (path && k >= SiteKind::Ambient && k <= SiteKind::LightVisibility);
}

// The callbacks of generated code: C functions that find their engine through KernelCall::user.
BatchContext& contextOf(rsl::KernelCall* c) { return *static_cast<BatchContext*>(c->user); }

void onService(rsl::KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* in, float* out) {
    BatchContext& c = contextOf(call);
    if (site == rsl::kSiteMark) {
        for (int i = 0; i < lanes; ++i) out[i] = float(c.emits.size());
        return;
    }
    if (site == rsl::kSiteRescale) { // rows: mark, factor (3), end mark
        uint32_t begin = 0, end = uint32_t(c.emits.size());
        for (int i = 0; i < lanes; ++i)
            if (mask >> i & 1) { begin = uint32_t(in[i]); end = uint32_t(in[size_t(4) * lanes + i]); break; }
        for (uint32_t e = begin; e < end && e < c.emits.size(); ++e) {
            EmitRecord& r = c.emits[e];
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < lanes; ++i)
                    if (mask >> i & 1) c.arena[r.offset + size_t(k) * lanes + i] *= in[size_t(1 + k) * lanes + i];
        }
        return;
    }
    const SiteInfo& s = c.bound->sites[site];
    if (isRequest(s.kind, c.bound->path)) {
        size_t rows = 0;
        for (rsl::ir::Kind k : s.site->argKinds) rows += size_t(rsl::ir::components(k));
        if (c.bound->kernel->facts().suspends) {
            c.requestSite = site;
            c.requestFirst = first;
            c.requestLanes = lanes;
            c.requestMask = mask;
            c.requestIn.assign(in, in + rows * lanes);
            c.requestOut = out;
            return;
        }
        EmitRecord e{site, first, lanes, mask, c.arena.size()};
        c.arena.insert(c.arena.end(), in, in + (rows + 3) * lanes);
        if (s.kind == SiteKind::LightVisibility) // the row of the light's index is replaced by the distance, which only the loop knows
            for (int i = 0; i < lanes && i < int(c.lightDistance.size()); ++i)
                c.arena[e.offset + size_t(3 + s.rows[0]) * lanes + i] = c.lightDistance[i];
        c.emits.push_back(e);
        return;
    }
    c.engine->service(c, site, first, mask, lanes, in, out);
}
int32_t onLightBegin(rsl::KernelCall* call, int32_t site, int32_t first, uint64_t mask, int32_t lanes, const float* rows) {
    BatchContext& c = contextOf(call);
    return c.engine->lightBegin(c, site, first, mask, lanes, rows);
}
uint64_t onLightFetch(rsl::KernelCall* call, int32_t site, int32_t light, int32_t first, uint64_t mask, int32_t lanes, float* out) {
    BatchContext& c = contextOf(call);
    return c.engine->lightFetch(c, light, first, mask, lanes, out);
}
void* onAlloc(rsl::KernelCall*, uint64_t bytes) { return ::operator new(bytes, std::align_val_t(64), std::nothrow); }
void onRelease(rsl::KernelCall*, void* p, uint64_t) { ::operator delete(p, std::align_val_t(64)); }

constexpr int32_t kGo = 0;
// Rays followed at once: enough to fill batches, few enough that their points stay in the cache of a core.
constexpr int kCacheSlice = limits::kSliceRays / 8;

} // namespace

void Engine::bindCall(rsl::KernelCall& call, BatchContext& c) {
    call.user = &c;
    call.service = onService;
    call.lightBegin = onLightBegin;
    call.lightFetch = onLightFetch;
    call.alloc = onAlloc;
    call.release = onRelease;
    call.stop = stop ? stop : &kGo;
}

/// A strip of a suspending kernel while it waits.
class KernelStrip final : public Sched::Strip {
public:
    KernelStrip(std::shared_ptr<BatchContext> c, void* handle, int first, int depth) : c_(std::move(c)), handle_(handle), first_(first), depth_(depth) {}
    ~KernelStrip() override { if (handle_) c_->bound->kernel->destroy(handle_); }
    int depth() const override { return depth_; }
    size_t frameBytes() const override { return 4096 + size_t(c_->bound->kernel->lanes()) * 256; }

    bool resume(Sched& s, std::span<const shading::TargetValue> results) override {
        const SiteInfo& site = c_->bound->sites[site_];
        for (size_t k = 0; k < results.size(); ++k) {
            int lane = laneOf_[k];
            auto put = [&](const char* name, int rows, const Color& v) {
                auto i = site.resultRows.find(name);
                if (i == site.resultRows.end()) return;
                for (int r = 0; r < rows; ++r) out_[size_t(i->second + r) * lanes_ + lane] = v[r];
            };
            if (site.site->resultType.base == rsl::Base::Float) put("", 1, Color(results[k].distance));
            else put("", 3, results[k].radiance);
            put("dist", 1, Color(results[k].distance));
            put("transmission", 3, results[k].transmission);
            put("hitnormal", 3, results[k].normal);
            if (const TraceSums* sums = ids_.empty() ? nullptr : c_->engine->sumsOf(ids_[k])) {
                put("transmission", 3, Color(1) - sums->value(TraceSums::Blocked));
                put("environmentcontribution", 3, sums->value(TraceSums::Environment));
                put("unshadowedenvironment", 3, sums->value(TraceSums::UnshadowedEnvironment));
                put("arealightcontribution", 3, sums->value(TraceSums::AreaLight));
                put("unshadowedarealight", 3, sums->value(TraceSums::UnshadowedAreaLight));
            }
        }
        for (TargetId id : ids_) c_->engine->traceSums_.erase(id);
        ids_.clear();
        c_->bound->kernel->resume(handle_);
        return advance(s, s.takeResuming());
    }

    /// After start or resume: ends, or waits for the request that was noted in the context.
    bool advance(Sched& s, std::unique_ptr<Sched::Strip> self) {
        Engine& e = *c_->engine;
        const auto& kernel = *c_->bound->kernel;
        if (kernel.finished(handle_)) {
            e.finishStrip(*c_, first_, kernel.lanes(), s);
            for (int i = first_; i < std::min(first_ + kernel.lanes(), int(c_->points.size())); ++i) s.release(c_->targets[i]);
            return true;
        }
        site_ = c_->requestSite;
        lanes_ = c_->requestLanes;
        out_ = c_->requestOut;
        laneOf_.clear();
        for (int lane = 0; lane < lanes_; ++lane)
            if ((c_->requestMask >> lane & 1) && first_ + lane < int(c_->points.size())) laneOf_.push_back(lane);
        std::vector<TargetId> ids(laneOf_.size());
        auto context = c_; // the strip may be resumed and gone when its last target is released
        auto lanesOf = laneOf_;
        int site = site_, lanes = lanes_, first = first_;
        std::vector<float> in = c_->requestIn;
        // Counted by site and lane: what other lanes of the strip ask for must not change this one's random numbers.
        size_t sites = c_->bound->sites.size();
        if (occurrences_.empty()) occurrences_.resize(sites * 64);
        std::vector<uint32_t> occurrence;
        for (int lane : laneOf_) occurrence.push_back(occurrences_[size_t(site_) * 64 + size_t(lane)]++);
        s.wait(std::move(self), int(laneOf_.size()), [&](int i, TargetId id) {
            ids[i] = id;
            s.hold(id);
        });
        const SiteInfo& info = context->bound->sites[site];
        if (info.trace && info.trace->sums) {
            ids_ = ids;
            for (TargetId id : ids) e.traceSums_[id] = {};
        }
        for (size_t k = 0; k < lanesOf.size(); ++k) {
            if (info.kind == SiteKind::LightVisibility) {
                e.lightVisibility(*context, info, first + lanesOf[k], in.data(), lanes, lanesOf[k], Color(1), ids[k],
                                  context->lightDistance[lanesOf[k]]);
                continue;
            }
            const size_t had = e.lobes.size();
            e.request(*context, info, first + lanesOf[k], in.data(), lanes, lanesOf[k], Color(1), ids[k], true, occurrence[k]);
            if (e.lobes.size() == had) continue;
            uint32_t& asked = asked_[size_t(lanesOf[k])];
            e.lobes.back().before = asked;
            asked += uint32_t(e.lobes.back().samples);
        }
        e.gather(*context, s);
        e.flushShadows(s);
        for (TargetId id : ids) s.release(id);
        return false;
    }

private:
    std::shared_ptr<BatchContext> c_;
    void* handle_;
    int first_, depth_;
    int site_ = 0, lanes_ = 0;
    std::vector<uint32_t> occurrences_;
    std::array<uint32_t, 64> asked_{}; ///< rays that a lane has asked for so far
    float* out_ = nullptr;
    std::vector<int> laneOf_;
    std::vector<TargetId> ids_;              ///< of the request that it waits for, when that asks for sums
};

void Engine::lightVisibility(BatchContext& c, const SiteInfo& s, int point, const float* in, int lanes, int lane, Color weight, TargetId target,
                             float distance) {
    auto f = [&](int row) { return in[size_t(row) * lanes + lane]; };
    Vec3 l(f(s.rows[1]), f(s.rows[1] + 1), f(s.rows[1] + 2));
    float length_ = length(l);
    if (!(length_ > 0)) return;
    const ShadePoint& p = c.points[point];
    Vec3 w = l / length_;
    Vec3 o = geometry::offsetOrigin(p.surface, w, length(p.P - p.surface.P));
    shadows.push_back({o, w, distance < 1e30f ? distance * (1 - 1e-4f) : 1e38f, weight, target, p.time, p.ray});
}

void Engine::finishStrip(BatchContext& c, int first, int lanes, Sched& sched) {
    shading::Batch& b = *c.batch;
    int ci = b.plan().Ci, oi = b.plan().Oi;
    const auto& wanted = world_->settings_.outputs;
    std::vector<int> wantedAt;
    for (const std::string& name : wanted) wantedAt.push_back(b.output(name));
    bool suspended = b.kernel().facts().suspends; // then nobody has asked for the atmosphere yet
    if (suspended) hazeOfBatch(c, first, lanes, false);
    for (int i = first; i < std::min(first + lanes, int(c.points.size())); ++i) {
        const PathRay& ray = c.rays[i];
        const SurfaceBinding& binding = world_->bindings_[c.bindings[i]];
        Color color = ci >= 0 ? b.color(ci, i) : Color(0), opacity = oi >= 0 ? b.color(oi, i) : Color(1);
        if (binding.matte && ray.type == RayType::Camera) {
            sched.setDistance(c.targets[i], 0);
            color = Color(0);
        }
        if (ray.first) {
            sched.setNearer(c.targets[i], length(c.points[i].I), c.points[i].N);
            sched.setTransmission(c.targets[i], Color(1) - opacity);
        }
        if (TraceSums* sums = sumsOf(c.targets[i])) sums->add(TraceSums::Blocked, ray.part * opacity);
        Color shown = color;
        if (binding.atmosphere && !(binding.matte && ray.type == RayType::Camera)) { // pairs were scaled in shadeGroup
            shown = c.haze[size_t(i)].shown;
            opacity = c.haze[size_t(i)].opacity;
        }
        sched.add(c.targets[i], ray.weight * shown);
        if (ray.cameraSample >= 0) {
            SampleResult& r = *results[ray.cameraSample];
            if (!binding.matte) r.opacity += ray.weight * opacity;
            float z = dot(c.points[i].P, Vec3(0, 0, 1));
            if (r.z >= 1e38f) r.z = z;
            else if (r.zSecond >= 1e38f) r.zSecond = z;
            size_t at = 0;
            for (size_t k = 0; k < wanted.size(); ++k) {
                int o = wantedAt[k], width = world_->outputWidths_[k];
                if (o >= 0)
                    for (int w = 0; w < std::min(width, rsl::ir::components(b.kernel().outputs()[o].kind)); ++w)
                        r.aovs[at + w] += (width == 3 ? ray.weight[w] : luminance(ray.weight)) * b.value(o, w, i);
                else if (!c.lightChannels.empty())
                    for (int w = 0; w < width; ++w)
                        r.aovs[at + w] += (width == 3 ? ray.weight[w] : luminance(ray.weight)) * c.lightChannels[size_t(i) * (c.lightChannels.size() / c.points.size()) + at + size_t(w)];
                at += size_t(width);
            }
        }
        if (opacity.x < 1 || opacity.y < 1 || opacity.z < 1) passThrough(ray, c.targets[i], c.points[i], Color(1) - opacity, sched);
    }
}

void Engine::passThrough(const PathRay& ray, TargetId target, const ShadePoint& p, const Color& transparency, Sched& sched) {
    Color t(std::clamp(transparency.x, 0.f, 1.f), std::clamp(transparency.y, 0.f, 1.f), std::clamp(transparency.z, 0.f, 1.f));
    float most = maxComponent(t);
    if (!(most > 0)) return;
    PathRay r = ray;
    r.weight = ray.weight * t;
    r.part = ray.part * t;
    if (world_->settings_.hider == Hider::Path && ray.bounces > 0 && most < 1) { // a gamble keeps the number of rays linear in depth
        if (random(ray).one(ray.vertex, kPassThrough, 0) >= most) return;
        r.weight = r.weight / most;
        r.part = r.part / most;
    }
    float travelled = length(p.I);
    r.origin = geometry::offsetOrigin(p.surface, ray.dir);
    r.maxDistance = ray.maxDistance - travelled;
    r.width = ray.width + ray.spread * travelled;
    r.shape = geometry::kNone;
    r.first = false;
    r.vertex = childVertex(ray.vertex, 0xfffff, 0);
    ++r.layers;
    if (r.layers > limits::kPathDepth / 32 || !(r.maxDistance > 0)) { ++counters.depthCap; return; }
    Sched::Task task;
    task.depth = r.bounces + r.layers;
    task.target = target;
    task.payload = r;
    sched.spawn(std::move(task));
}

void Engine::misses(std::span<const Sched::Task* const> tasks, Sched& sched) {
    for (const Sched::Task* t : tasks) // the map of a trace()
        if (const PathRay& r = t->payload; maxComponent(r.environment) > 0) {
            sched.add(t->target, r.weight * r.environment);
            if (TraceSums* sums = sumsOf(t->target)) sums->add(TraceSums::Environment, r.weight * r.environment);
        }
    if (world_->settings_.hider != Hider::Path || tasks.empty()) return;
    std::vector<ShadePoint> q;
    std::vector<const Sched::Task*> of;
    std::vector<LightValue> value;
    for (const BoundLight& l : world_->lights_) {
        if ((l.kind != LightKind::Environment && l.kind != LightKind::Ambient) || !l.kernel) continue; // a light whose shader was not found gives nothing
        q.clear();
        of.clear();
        litBy_.clear();
        for (const Sched::Task* t : tasks) {
            const PathRay& r = t->payload;
            if (l.kind == LightKind::Ambient ? r.type != RayType::Diffuse : r.fromTrace && l.strategy == LightStrategy::Illuminance) continue;
            ShadePoint& p = q.emplace_back();
            p.Ps = r.origin;
            p.P = r.origin + r.dir;
            p.N = -r.dir;
            p.time = r.time;
            p.ray = &r;
            of.push_back(t);
            litBy_.push_back(r.lit);
        }
        value.assign(q.size(), {});
        LitSurface lit;
        if (l.asksSurface) lit = litBy(litBy_);
        evaluateLight(l, q, value, {.lit = l.asksSurface ? &lit : nullptr});
        for (size_t i = 0; i < of.size(); ++i)
            if (value[i].lit) {
                const PathRay& r = of[i]->payload;
                const bool weighed = l.kind == LightKind::Environment && r.bounces > 0 && !r.fromTrace; // met by a lobe of a lighting shadeop
                sched.add(of[i]->target, r.weight * value[i].Cl * (weighed ? value[i].kept(r.type) : 1.f));
            }
    }
}

void Engine::emission(std::span<const Met> met, Sched& sched) {
    const Settings& set = world_->settings_;
    std::vector<ShadePoint> q;
    std::vector<LightValue> value;
    for (size_t first = 0, end; first < met.size(); first = end) {
        q.clear();
        litBy_.clear();
        for (end = first; end < met.size() && met[end].light == met[first].light; ++end) {
            const PathRay& r = *met[end].point->ray;
            q.push_back(*met[end].point);
            ShadePoint& p = q.back();
            p.P = p.surface.displaced ? p.surface.displacedP : p.surface.P;
            p.N = p.surface.n;
            p.Ps = r.lobePdf >= 0 ? r.lobeOrigin : r.origin;
            litBy_.push_back(r.lit);
        }
        const BoundLight& light = world_->lights_[size_t(met[first].light)];
        value.assign(q.size(), {});
        LitSurface lit;
        if (light.asksSurface) lit = litBy(litBy_);
        evaluateLight(light, q, value, {.lit = light.asksSurface ? &lit : nullptr});
        for (size_t i = first; i < end; ++i) {
            const LightValue& v = value[i - first];
            if (!v.lit || !(maxComponent(v.Cl) > 0)) continue;
            const ShadePoint& p = *met[i].point;
            const PathRay& r = *p.ray;
            float weight = 1;
            if (r.lobePdf >= 0 && light.emitter) {
                float pdf = light.emitter->pdf(p.shape, p.surface, r.lobeOrigin);
                if (set.hider == Hider::Path && r.lobeBinding >= 0) pdf *= chanceOf(met[i].light, r.lobeBinding, r.lobeOrigin);
                weight = set.lightOnly ? 0 : misWeight(r.lobePdf, pdf);
            }
            if (r.bounces > 0 && !r.fromTrace) weight *= v.kept(r.type);
            sched.add(met[i].target, r.weight * v.Cl * weight);
            if (TraceSums* sums = sumsOf(met[i].target); sums && maxComponent(r.part) > 0) sums->add(TraceSums::AreaLight, r.weight * v.Cl * weight);
        }
    }
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
        if (r.type == RayType::Camera)
            for (const auto& [point, normal] : world_->clippingPlanes_) {
                double height = dot(normal, Vec3d(r.origin) - point), climb = dot(normal, Vec3d(r.dir)), t = -height / climb;
                if (climb > 0) rays[i].tfar = std::min(rays[i].tfar, float(std::max(t, 0.0)));
                else if (climb < 0) rays[i].tnear = std::max(rays[i].tnear, float(std::min(t, 1e37)));
                else if (height > 0) rays[i].tfar = 0; // along the plane, on its cut side
            }
        rays[i].time = r.time;
        rays[i].mask = visibilityBit(r.type);
        rays[i].excludeShape = r.shape;
        rays[i].excludePrim = r.prim;
        switch (r.type) {
        case RayType::Camera: ++counters.camera; break;
        case RayType::Diffuse: ++counters.diffuse; break;
        case RayType::Specular: ++counters.specular; break;
        default: ++counters.transmission;
        }
    }
    world_->accel_->intersect(rays, hits);

    // Points by program and light list; inside a group in the order of the slice.
    std::vector<std::shared_ptr<BatchContext>> groups(static_cast<size_t>(world_->groups_));
    std::vector<int> sizes(groups.size());
    for (size_t i = 0; i < n; ++i)
        if (hits[i].valid()) ++sizes[size_t(world_->bindings_[size_t(world_->bindingOf_[hits[i].shape])].group)];
    for (size_t g = 0; g < groups.size(); ++g) {
        if (!sizes[g]) continue;
        auto& c = groups[g] = takeContext();
        c->engine = this;
        c->points.resize(size_t(sizes[g])); // pointers into points and rays stay good
        c->rays.reserve(size_t(sizes[g]));
        c->targets.reserve(size_t(sizes[g]));
        c->bindings.reserve(size_t(sizes[g]));
    }
    std::vector<Met> met;
    std::vector<const Sched::Task*> missed;
    for (size_t i = 0; i < n; ++i) {
        if (!hits[i].valid()) { missed.push_back(&slice[i]); continue; }
        const PathRay& r = slice[i].payload;
        int binding = world_->bindingOf_[hits[i].shape];
        const SurfaceBinding& b = world_->bindings_[size_t(binding)];
        BatchContext& c = *groups[size_t(b.group)];
        c.rays.push_back(r);
        c.targets.push_back(slice[i].target);
        c.bindings.push_back(binding);
        ShadePoint& p = c.points[c.rays.size() - 1]; // may hold another point's numbers: all of it is written
        p.ray = &c.rays.back();
        p.Ci = p.Oi = p.Ps = p.Ns = p.viewI = Vec3();
        p.lit = nullptr;
        p.alpha = 0;
        p.shape = world_->shapes_[hits[i].shape].get();
        world_->accel_->point(hits[i], p.surface);
        p.P = p.surface.P;
        p.N = p.surface.N;
        p.I = p.P - r.origin;
        p.E = r.type == RayType::Camera ? Vec3(0, 0, 0) : r.origin;
        if (r.type == RayType::Camera && r.layers > 0) p.I = p.P - p.E; // seen through something: the eye has not moved
        p.time = r.time;
        p.task = int(i);
        if (world_->footprints_) setFootprint(p, r, length(p.P - r.origin), r.type == RayType::Camera ? b.shadingRate : 1);
        if (b.areaLight < 0 || !r.wantsLight || (b.matte && r.type == RayType::Camera)) continue;
        if (world_->settings_.hider != Hider::Path && r.lobePdf < 0) continue;
        if (r.lobeBinding >= 0) { // a lobe that samples lights: those that are off for its surface do not light it by chance either
            const auto& on = world_->bindings_[size_t(r.lobeBinding)].lights;
            if (std::find(on.begin(), on.end(), b.areaLight) == on.end()) continue;
        }
        const BoundLight& light = world_->lights_[size_t(b.areaLight)];
        if (r.fromTrace && light.strategy == LightStrategy::Illuminance) continue;
        met.push_back({b.areaLight, slice[i].target, &p});
        for (int part : light.parts)
            if (world_->lights_[size_t(part)].kind == LightKind::Area) met.push_back({part, slice[i].target, &p});
    }
    misses(missed, sched);
    std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.light < b.light; });
    emission(met, sched);
    for (auto& c : groups) {
        if (!c) continue;
        bool same = std::all_of(c->bindings.begin(), c->bindings.end(), [&](int b) { return b == c->bindings[0]; });
        c->binding = &world_->bindings_[size_t(c->bindings[0])];
        c->bound = same && !c->binding->usesObjectSpace ? &c->binding->surfaceS : &c->binding->surfaceV;
        shadeGroup(c, sched);
        giveBack(std::move(c));
    }
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
    c->rays.clear(); // points stay: follow() writes them again
    c->targets.clear();
    c->bindings.clear();
    c->emits.clear();
    c->arena.clear();
    c->haze.clear();
    c->lightDistance.clear();
    c->lightChannels.clear();
    c->requestSite = -1;
    for (LightLoop& loop : c->loops) loop.reset(-1);
    c->lit = nullptr;
    c->lightVisibilityDistance = 0;
    pool_.push_back(std::move(c));
}

void Engine::shadeGroup(std::shared_ptr<BatchContext> c, Sched& sched) {
    // Fills the batch; its points' instances are few.
    auto fill = [&](BatchContext& to, InstanceRef SurfaceBinding::*which) {
        views_.clear();
        viewOf_.clear();
        slotOf_.resize(world_->bindings_.size(), -1);
        for (int b : to.bindings) {
            int& slot = slotOf_[size_t(b)];
            if (slot < 0) {
                const InstanceRef& i = world_->bindings_[size_t(b)].*which;
                slot = int(views_.size());
                views_.push_back({&i->parameters, &i->toCurrent});
            }
            viewOf_.push_back(uint32_t(slot));
        }
        for (int b : to.bindings) slotOf_[size_t(b)] = -1;
        if (!to.batch) to.batch = std::make_shared<shading::Batch>();
        to.batch->assign(to.bound->kernel, *to.bound->plan, to.points, views_, viewOf_, *world_);
        bindCall(to.batch->call(), to);
    };
    // Displacement again at the hit, for P, N (design decision 9). All points of a group with displacement share its binding.
    if (c->binding->displacement) {
        auto d = std::make_shared<BatchContext>(*c);
        for (size_t k = 0; k < d->points.size(); ++k) d->points[k].ray = &d->rays[k];
        d->bound = &c->binding->displacementS;
        d->batch.reset(); // c's own
        fill(*d, &SurfaceBinding::displacement);
        if (!d->bound->kernel->facts().suspends) {
            d->bound->kernel->run(&d->batch->call());
            int po = d->batch->output("P"), no = d->batch->output("N");
            int dpu = d->batch->output("Du:P"), dpv = d->batch->output("Dv:P"), dnu = d->batch->output("Du:N"), dnv = d->batch->output("Dv:N");
            for (size_t k = 0; k < c->points.size(); ++k) {
                ShadePoint& p = c->points[k];
                if (po >= 0) { p.P = d->batch->color(po, int(k)); p.I = p.P - c->rays[k].origin; }
                if (no >= 0) p.N = d->batch->color(no, int(k));
                // The surface shader's derivatives are those of the displaced surface. Its second partials stay those of the plain one.
                if (po >= 0 && dpu >= 0 && dpv >= 0) {
                    p.surface.dPdu = d->batch->color(dpu, int(k));
                    p.surface.dPdv = d->batch->color(dpv, int(k));
                    p.surface.Ng = cross(p.surface.dPdu, p.surface.dPdv) * p.surface.orientation;
                }
                if (no >= 0 && dnu >= 0 && dnv >= 0) {
                    p.surface.dNdu = d->batch->color(dnu, int(k));
                    p.surface.dNdv = d->batch->color(dnv, int(k));
                }
                if (p.surface.displaced) { // rays left and met the facet; shading offsets start there
                    p.surface.P = p.surface.displacedP;
                    p.surface.n = p.surface.displacedN;
                    p.P = p.surface.displacedP;
                }
            }
        }
    }
    const auto& kernel = *c->bound->kernel;
    fill(*c, &SurfaceBinding::surface);
    if (c->binding->moveS) moveToFacets(*c); // the kernel moves P itself: it begins with the surface as it was
    int n = int(c->points.size());
    counters.points += uint64_t(n);
    ++counters.batches;
    counters.lanesUsed += uint64_t(n);
    counters.lanesRun += uint64_t((n + kernel.lanes() - 1) / kernel.lanes() * kernel.lanes());

    if (kernel.facts().suspends) {
        for (int first = 0; first < n; first += kernel.lanes()) {
            for (int i = first; i < std::min(first + kernel.lanes(), n); ++i) sched.hold(c->targets[i]);
            void* h = kernel.start(&c->batch->call(), first);
            if (!h) {
                ++counters.overLimit;
                for (int i = first; i < std::min(first + kernel.lanes(), n); ++i) sched.release(c->targets[i]);
                continue;
            }
            auto strip = std::make_unique<KernelStrip>(c, h, first, c->rays[first].bounces + c->rays[first].layers);
            KernelStrip* s = strip.get();
            s->advance(sched, std::move(strip));
        }
        return;
    }
    kernel.run(&c->batch->call());

    // Affine pairs by point, in order of emission. Atmosphere scales them.
    bool hazy = std::any_of(c->bindings.begin(), c->bindings.end(), [&](int b) { return world_->bindings_[size_t(b)].atmosphere != nullptr; });
    std::vector<Color> slope(n, Color(1));
    if (hazy) {
        hazeOfBatch(*c, 0, n, !c->emits.empty());
        for (int i = 0; i < n; ++i)
            if (world_->bindings_[size_t(c->bindings[size_t(i)])].atmosphere) slope[size_t(i)] = c->haze[size_t(i)].slope;
    }
    std::vector<uint32_t>& occurrence = occurrence_;
    occurrence.assign(c->emits.empty() ? 0 : c->bound->sites.size() * size_t(n), 0);
    for (const EmitRecord& e : c->emits) {
        const SiteInfo& s = c->bound->sites[e.site];
        const float* rows = c->arena.data() + e.offset;
        for (int lane = 0; lane < e.lanes; ++lane) {
            int point = e.first + lane;
            if (!(e.mask >> lane & 1) || point >= n) continue;
            Color weight = Color(rows[lane], rows[e.lanes + lane], rows[2 * e.lanes + lane]) * slope[point];
            if (!(std::isfinite(weight.x) && std::isfinite(weight.y) && std::isfinite(weight.z))) { ++counters.nonFinite; continue; }
            if (weight == Color(0)) continue;
            if (world_->bindings_[c->bindings[point]].matte && c->rays[point].type == RayType::Camera) continue;
            const float* args = rows + size_t(3) * e.lanes;
            if (s.kind == SiteKind::LightVisibility) {
                lightVisibility(*c, s, point, args, e.lanes, lane, weight * c->rays[point].weight, c->targets[point],
                                args[size_t(s.rows[0]) * e.lanes + lane]);
                continue;
            }
            if (s.kind == SiteKind::Transmission) weight *= c->rays[point].weight;
            request(*c, s, point, args, e.lanes, lane, weight, c->targets[point], false, occurrence[size_t(e.site) * size_t(n) + size_t(point)]++);
        }
    }
    gather(*c, sched);
    flushShadows(sched);
    finishStrip(*c, 0, n, sched);
}

bool Engine::trace(std::span<const CameraRay> rays, std::span<SampleResult> out, const volatile int32_t* stopFlag) {
    stop = stopFlag;
    if (!sched_) sched_ = std::make_unique<Sched>(*this, stopFlag, limits::kFrameBytesPerThread, kCacheSlice);
    Sched& sched = *sched_;
    sched.restart(stopFlag);
    size_t aovs = 0;
    for (int w : world_->outputWidths_) aovs += size_t(w);
    results.resize(rays.size());
    std::vector<TargetId> roots(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        const CameraRay& c = rays[i];
        out[i] = SampleResult{};
        out[i].aovs.assign(aovs, 0.f);
        results[i] = &out[i];
        roots[i] = sched.newRoot();
        PathRay& r = sched.spawn(0, roots[i]).payload;
        r.origin = c.origin;
        r.dir = c.direction;
        r.px = c.px;
        r.py = c.py;
        r.sample = c.sample;
        r.time = c.time;
        r.width = c.width;
        r.spread = c.spread;
        r.cameraSample = int(i);
    }
    counters.paths += rays.size();
    bool done = sched.run();
    float clampAt = world_->settings_.sampleClamp;
    for (size_t i = 0; i < rays.size(); ++i) {
        Color c = sched.value(roots[i]).radiance;
        float m = maxComponent(c);
        if (clampAt > 0 && m > clampAt) c *= clampAt / m; // pathtracer.md 6
        out[i].color = c;
        Color& o = out[i].opacity;
        o = {std::min(o.x, 1.f), std::min(o.y, 1.f), std::min(o.z, 1.f)};
    }
    counters.nonFinite += sched.nonFinite();
    counters.overLimit += sched.overLimit();
    counters.peakFrameBytes = std::max(counters.peakFrameBytes, sched.peakFrameBytes());
    lobes.clear();
    shadows.clear();
    traceSums_.clear();
    litValues_.clear();
    return done;
}

struct Integrator::Impl {
    Engine engine;
    Impl(std::shared_ptr<const WorldImpl> w, Diagnostics& d) : engine(std::move(w), d) {}
};
Integrator::Integrator(std::shared_ptr<const World> w, Diagnostics& d)
    : impl_(std::make_unique<Impl>(std::static_pointer_cast<const WorldImpl>(std::move(w)), d)) {}
Integrator::~Integrator() = default;
bool Integrator::trace(std::span<const CameraRay> r, std::span<SampleResult> out, const volatile int32_t* stop) { return impl_->engine.trace(r, out, stop); }
const Counters& Integrator::counters() const { return impl_->engine.counters; }

} // namespace alpenglow::transport

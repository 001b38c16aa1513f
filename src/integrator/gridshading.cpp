#include "integrator/gridshading.h"
#include "base/hash.h"
#include "integrator/context.h"
#include "integrator/intersector.h"
#include "integrator/limits.h"
#include "integrator/pipeline.h"
#include "integrator/raystore.h"
#include "scene/scene.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

namespace {

constexpr int kColour = 0, kOpacity = 3, kClear = 6, kOutputs = 9; ///< offsets in a slot, in floats
constexpr uint32_t kFree = 0xffffffffu;

Color colourAt(const float* v) { return {v[0], v[1], v[2]}; }
void put(float* to, const Color& c) { to[0] = c.x, to[1] = c.y, to[2] = c.z; }

} // namespace

bool GridShading::takes(const WorldImpl& w) {
    const bool ownTime = w.settings().hider == Hider::Raytrace ? w.shutter().opens() : !w.shadesAtOpen();
    // Grids start outside of all volumes: other origins than the eye may be inside.
    const bool outside = w.media().empty() || (w.eye().count == 0 && w.frame().options.projection == "perspective");
    return w.settings().micropolygons && w.settings().hider != Hider::Path && !ownTime && outside;
}

GridShading::GridShading(Pipeline& p)
    : pipeline_(p), world_(p.world()), lattices_(world_), camera_(world_.frame().options), stride_(kOutputs) {
    seesSky_ = std::any_of(world_.skies().begin(), world_.skies().end(), [&](int l) {
        const BoundLight& sky = world_.lights()[size_t(l)];
        return sky.kind == LightKind::Environment && sky.strategy == LightStrategy::Trace;
    });
    for (const int width : world_.widthsOfOutputs()) {
        for (int k = 0; k < width; ++k) colour_.push_back(width % 3 == 0 ? uint8_t(k % 3) : 3);
        stride_ += size_t(width);
    }
    values_.reserve(limits::kMicropolygonBytes / sizeof(float));
    keys_.reserve(limits::kMicropolygonBytes / sizeof(float) / stride_);
    forget();
}

void GridShading::forget() {
    keys_.clear();
    values_.clear();
    table_.assign(1024, {kFree, 0});
    last_ = kFree;
}

/// Doubles the size of the table.
void GridShading::grow() {
    table_.assign(2 * table_.size(), {kFree, 0});
    for (uint32_t slot = 0; slot < keys_.size(); ++slot) {
        if (!keys_[slot].shared()) continue;
        const uint64_t hash = keys_[slot].hash();
        size_t at = hash & (table_.size() - 1);
        while (table_[at].slot != kFree) at = (at + 1) & (table_.size() - 1);
        table_[at] = {slot, uint32_t(hash >> 32)};
    }
}

void GridShading::begin(std::span<const CameraRay> rays, std::span<SampleResult> out) {
    samples_.resize(rays.size());
    own_.clear();
    for (size_t i = 0; i < rays.size(); ++i) {
        std::vector<float> outputs = std::move(out[i].aovs); // reuses its memory
        outputs.assign(colour_.size(), 0.f);
        out[i] = SampleResult{};
        out[i].aovs = std::move(outputs);
        samples_[i] = Sample{};
        samples_[i].number = uint32_t(i);
        samples_[i].origin = rays[i].origin;
    }
}

/// Finds the next hits of the continuing samples: hits_, points_.
void GridShading::intersect(std::span<const CameraRay> rays) {
    rays_.resize(samples_.size());
    hits_.assign(samples_.size(), {});
    points_.resize(samples_.size());
    for (size_t i = 0; i < samples_.size(); ++i) {
        const CameraRay& c = rays[samples_[i].number];
        accel::Ray& r = rays_[i] = accel::Ray{};
        r.org = samples_[i].origin;
        r.dir = c.direction;
        r.time = c.shutter;
        r.mask = visibilityBit(RayType::Camera);
        r.sides = shading::kCameraKind.set.sides;
        if (world_.fades()) r.level = pipeline_.stages().store.levelOf(c);
        pipeline_.stages().intersector.clip(r);
    }
    pipeline_.stages().intersector.intersect(rays_, hits_, true);
    unfinished_ |= pipeline_.unfinished();
    for (size_t i = 0; i < samples_.size(); ++i) points_[i] = rays_[i].org + rays_[i].dir * float(hits_[i].distance);
}

/// The slot of a micropolygon; a new one is queued for shading.
uint32_t GridShading::slotOf(const MicropolygonShare& s) {
    if (last_ < keys_.size() && keys_[last_] == s.key && s.key.shared()) return last_; // samples of a pixel are consecutive
    const uint32_t next = uint32_t(keys_.size());
    if (s.key.shared()) {
        if (2 * keys_.size() >= table_.size()) grow();
        const uint64_t hash = s.key.hash();
        size_t at = hash & (table_.size() - 1);
        for (; table_[at].slot != kFree; at = (at + 1) & (table_.size() - 1))
            if (table_[at].tag == uint32_t(hash >> 32) && keys_[table_[at].slot] == s.key) return last_ = table_[at].slot;
        table_[at] = {next, uint32_t(hash >> 32)};
    }
    keys_.push_back(s.key);
    fresh_.push_back(s);
    lattices_.place(fresh_.back());
    return last_ = next;
}

void GridShading::findShares() {
    shares_.clear();
    fresh_.clear();
    firstFresh_ = uint32_t(keys_.size());
    for (Sample& s : samples_) s.n = 0;
    lattices_.find(hits_, points_, found_);
    for (const Micropolygons::Found& f : found_) {
        Sample& s = samples_[f.hit];
        if (s.n++ == 0) s.first = uint32_t(shares_.size());
        shares_.push_back({slotOf(f.share), f.share.weight});
    }
}

/// Makes the rays from the eye to micropolygons: work_.
void GridShading::aimAt(std::span<const MicropolygonShare> some) {
    work_.points.resize(some.size());
    work_.places.resize(some.size());
    work_.rays.clear();
    for (size_t i = 0; i < some.size();) { // runs of one shape
        work_.hits.clear();
        const size_t first = i;
        for (; i < some.size() && some[i].key.shape == some[first].key.shape; ++i)
            work_.hits.push_back({some[i].key.prim, some[i].b1, some[i].b2, &work_.places[i], 0});
        world_.shapes()[some[first].key.shape]->points(work_.hits, world_.needs().footprints ? geometry::kNeedPartials : 0);
    }
    const uint64_t run = world_.prints().newRun();
    for (size_t i = 0; i < some.size(); ++i) {
        work_.rays.push_back(rayTo(some[i], work_.places[i], work_.points[i]));
        work_.points[i].run = run;
    }
}

/// The ray from the eye to a micropolygon at p.
CameraRay GridShading::rayTo(const MicropolygonShare& s, const geometry::SurfacePoint& p, shading::GridPoint& point) {
    MicropolygonKey key = s.key; // random numbers must not depend on which procedurals were expanded
    key.shape = world_.keyOfShape(s.key.shape);
    point = {s.key.shape, s.key.prim, s.b1, s.b2};
    point.corner = false;
    point.micropolygon = key.hash();
    if (!key.shared()) point.micropolygon += mix64(std::bit_cast<uint64_t>(s.b1)) + 3 * mix64(std::bit_cast<uint64_t>(s.b2));
    const Vec3 P = p.displaced ? p.displacedP : p.P;
    CameraRay r;
    r.direction = camera_.towards(P);
    if (camera_.perspective) {
        r.spread = camera_.pixel * r.direction.z / 2;
        point.distance = length(P);
    } else {
        r.origin = Vec3(P.x, P.y, std::min(0.f, P.z - 1));
        r.width = camera_.pixel / 2;
        point.distance = P.z - r.origin.z;
    }
    r.cosine = r.direction.z;
    r.time = world_.shutter().opens() ? float(world_.shutter().open) : 0;
    r.px = int(s.key.prim);
    r.py = int(key.shape);
    r.grid = &point;
    if (world_.needs().footprints) {
        const float rate = world_.bindings()[size_t(world_.bindingOf()[s.key.shape])].shadingRate;
        const Vec2 seen = shading::footprintAt(p, {r.width, r.spread}, r.direction, length(p.P - r.origin), rate);
        const Vec2 steps = lattices_.stepsOf(s, seen);
        point.du = steps.x, point.dv = steps.y;
    }
    return r;
}

void GridShading::keep(uint32_t slot, const SampleResult& r) {
    float* v = values(slot);
    put(v + kColour, r.color);
    put(v + kOpacity, r.opacity);
    put(v + kClear, r.behind);
    std::copy(r.aovs.begin(), r.aovs.end(), v + kOutputs);
}

/// Shades the queued micropolygons. Returns false if stopped; the cache is then invalid.
bool GridShading::shade(const StopFlag* stop) {
    values_.resize(keys_.size() * stride_);
    constexpr size_t kAtOnce = 4096;
    for (size_t first = 0; first < fresh_.size(); first += kAtOnce) {
        const size_t n = std::min(kAtOnce, fresh_.size() - first);
        aimAt(std::span(fresh_).subspan(first, n));
        std::vector<SampleResult>& results = work_.results;
        results.resize(n);
        Counters& c = pipeline_.counters();
        const uint64_t paths = c.paths, camera = c.camera;
        const bool whole = pipeline_.trace(work_.rays, results, stop);
        c.paths = paths, c.camera = camera; // these are counted by sample
        unfinished_ |= pipeline_.unfinished();
        if (!whole) return false;
        for (size_t i = 0; i < n; ++i) keep(uint32_t(firstFresh_ + first + i), results[i]);
    }
    return true;
}

/// Continues a sample behind its hit, which has transparency `clear`. Returns false if the sample ends.
bool GridShading::goesOn(Sample& s, const CameraRay& ray, const accel::Hit& hit, const Color& clear) const {
    if (!(maxComponent(clear) > 0)) return false;
    if (++s.layers > limits::kPathDepth / 32) {
        ++pipeline_.counters().depthCap;
        return false;
    }
    geometry::SurfacePoint p;
    world_.accel().point(hit, p, 0);
    s.origin = p.displaced ? geometry::offsetOrigin(p.displacedP, p.displacedN, p.facetError, ray.direction)
                           : geometry::offsetOrigin(p, ray.direction);
    s.weight *= clear;
    return true;
}

/// Whether a sample must be shaded at its own hit: it enters a volume, through which its path is its own, or it reaches a sky.
bool GridShading::ownWay(const Sample& s, const accel::Hit& hit) const {
    if (s.n == 0) return seesSky_ && !hit.valid();
    const SurfaceBinding& b = world_.bindings()[size_t(world_.bindingOf()[hit.shape])];
    return b.inside >= 0 || b.outside >= 0;
}

/// Adds the hits of samples to their results. Continuing samples stay in samples_.
void GridShading::show(std::span<const CameraRay> rays, std::span<SampleResult> out) {
    size_t left = 0;
    for (size_t i = 0; i < samples_.size(); ++i) {
        Sample s = samples_[i];
        if (ownWay(s, hits_[i])) {
            own_.push_back(s.number);
            continue;
        }
        if (s.n == 0) continue;
        SampleResult& r = out[s.number];
        const CameraRay& ray = rays[s.number];
        const float z = s.origin.z + ray.direction.z * float(hits_[i].distance);
        if (r.z >= 1e38f) r.z = z;
        else if (r.zSecond >= 1e38f) r.zSecond = z;
        Color clear(0);
        const Color w = s.weight;
        const float grey = luminance(w);
        for (uint32_t k = s.first; k < s.first + s.n; ++k) {
            const float* v = values(shares_[k].slot);
            const float part = shares_[k].weight;
            r.color += w * part * colourAt(v + kColour);
            r.opacity += w * part * colourAt(v + kOpacity);
            clear += part * colourAt(v + kClear);
            for (size_t o = 0; o < colour_.size(); ++o)
                r.aovs[o] += part * (colour_[o] < 3 ? w[colour_[o]] : grey) * v[kOutputs + o];
        }
        if (goesOn(s, ray, hits_[i], clear)) samples_[left++] = s;
    }
    samples_.resize(left);
}

bool GridShading::trace(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
    pipeline_.stages().context.stop = stop; // visibility is computed before anything is shaded
    unfinished_ = false;
    const bool whole = follow(rays, out, stop) && followSampleBySample(rays, out, stop);
    if (!whole || unfinished_) forget(); // shading results are undefined
    pipeline_.unfinished() = unfinished_;
    return whole;
}

bool GridShading::depths(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
    pipeline_.stages().context.stop = stop;
    pipeline_.unfinished() = false;
    begin(rays, out);
    pipeline_.counters().paths += rays.size();
    pipeline_.counters().camera += rays.size();
    intersect(rays);
    for (size_t i = 0; i < rays.size(); ++i)
        if (hits_[i].valid()) out[i].z = rays[i].origin.z + rays[i].direction.z * float(hits_[i].distance);
    return !(stop && *stop);
}

bool GridShading::follow(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
    begin(rays, out);
    pipeline_.counters().paths += rays.size();
    pipeline_.counters().camera += rays.size();
    while (!samples_.empty()) {
        if (values_.size() * sizeof(float) > limits::kMicropolygonBytes) forget(); // between layers, when no sample holds a slot
        pipeline_.unfinished() = false;
        intersect(rays);
        if (stop && *stop) return false;
        findShares();
        if (!shade(stop)) return false;
        show(rays, out);
    }
    const float clampAt = world_.settings().sampleClamp;
    for (SampleResult& r : out) {
        const float m = maxComponent(r.color);
        if (clampAt > 0 && m > clampAt) r.color *= clampAt / m; // docs/design/slproject.md, "Sample clamp"
        r.opacity = {std::min(r.opacity.x, 1.f), std::min(r.opacity.y, 1.f), std::min(r.opacity.z, 1.f)};
    }
    return true;
}

bool GridShading::followSampleBySample(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
    if (own_.empty()) return true;
    std::vector<CameraRay> some;
    for (const uint32_t i : own_) some.push_back(rays[i]);
    std::vector<SampleResult> results(some.size());
    pipeline_.counters().paths -= some.size();
    pipeline_.counters().camera -= some.size();
    if (!pipeline_.trace(some, results, stop)) return false;
    unfinished_ |= pipeline_.unfinished();
    for (size_t k = 0; k < own_.size(); ++k) out[own_[k]] = std::move(results[k]);
    return true;
}

} // namespace alpenglow::integrator

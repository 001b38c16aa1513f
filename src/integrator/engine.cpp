// The engine of a thread: calls of trace(), and what rays and batches share.
#include "base/memory.h"
#include "integrator/gather.h"
#include "integrator/medium.h"
#include "integrator/rowshading.h"
#include "shading/gridpoint.h"
#include <algorithm>
#include <limits>

namespace alpenglow::transport {

void Counters::operator+=(const Counters& o) {
    reflected += o.reflected;
    refracted += o.refracted;
    totalReflected += o.totalReflected;
    ignored += o.ignored;
    tests += o.tests;
    hits += o.hits;
    camera += o.camera;
    diffuse += o.diffuse;
    specular += o.specular;
    transmission += o.transmission;
    shadow += o.shadow;
    points += o.points;
    inBlocks += o.inBlocks;
    batches += o.batches;
    lanesUsed += o.lanesUsed;
    lanesRun += o.lanesRun;
    nonFinite += o.nonFinite;
    overLimit += o.overLimit;
    depthCap += o.depthCap;
    depthSum += o.depthSum;
    paths += o.paths;
    records += o.records;
    interpolated += o.interpolated;
    depthMax = std::max(depthMax, o.depthMax);
    peakFrameBytes = std::max(peakFrameBytes, o.peakFrameBytes);
}

Engine::Engine(std::shared_ptr<const WorldImpl> w, Diagnostics& d)
    : totalReflection_(rsl::internString("totalreflection")), world_(std::move(w)), diagnostics_(d),
      seed_(world_->settings_.seed), rules_(world_->settings_), answers_(*world_, d, this) {
    noSample_.numbers = render::SampleNumbers(render::Sampler(seed_, 0, 0), 0);
    prepareLightPaths();
    for (const int l : world_->skies_) ambientLights_ |= world_->lights_[size_t(l)].kind == LightKind::Ambient;
    blockVertices_ = std::make_unique<BlockVertices>(*this);
    rows_ = std::make_unique<RowShading>(*this, *blockVertices_);
    const auto event = [](const Medium& m) { return m.homogeneous || m.priority != 0; };
    if (std::any_of(world_->media_.begin(), world_->media_.end(), event)) {
        flightsInMedia_ = std::make_unique<MediumFlights>();
        happens(*flightsInMedia_);
    }
}

Engine::~Engine() { // strips of a frame that was given up need their kernels
    inner_.reset();
    sched_.reset();
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

uint64_t& Engine::raysOf(RayType t) {
    switch (t) {
    case RayType::Camera:
        return counters.camera;
    case RayType::Diffuse:
        return counters.diffuse;
    case RayType::Specular:
        return counters.specular;
    default:
        return counters.transmission;
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
    freeExtras(*c);
    c->forget(); // points stay: follow() writes them again
    c->targets.clear();
    c->hits.clear();
    c->emits.clear();
    c->emitted = 0;
    c->failure = nullptr;
    c->arena.clear();
    c->haze.clear();
    c->depths.clear();
    c->flown.clear();
    c->clear.clear();
    c->passes.clear();
    c->opaque = c->indirectKept = false;
    c->requestSite = -1;
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

void Engine::beginRay(const CameraRay& c, size_t i, PathRay& r) {
    r.origin = c.origin;
    r.dir = c.direction;
    PathSample& sample = samples_[i];
    sample = {c.px,   c.py,      c.sample,
              int(i), c.time,    c.shutter,
              0.5f,   c.records, render::SampleNumbers(render::Sampler(seed_, c.px, c.py), c.sample),
              c.grid};
    r.sample = &sample;
    r.footprint = {c.width, c.spread};
    r.setStart(c.start);
    r.media = world_->eye_.count && !c.grid ? &world_->eye_ : nullptr;
    if (c.grid && c.grid->micropolygon) {
        const auto half = [&](int shift) { return int(c.grid->micropolygon >> shift & 0x3fffffff) - (1 << 29); }; // as of pixels
        sample.numbers = render::SampleNumbers(render::Sampler(seed_, half(0), half(32)), c.sample);
    }
    if (world_->fades_) sample.level = levelOfSample(c);
    r.counts = true;
}

void Engine::beginTrace() {
    spoiled_.clear();
    waiting_.clear();
    hitQueues_.clear();
    groupsWithHits_.clear();
    hitsWaiting_ = 0;
}

void Engine::endTrace(const Sched& sched) {
    counters.nonFinite += sched.nonFinite();
    counters.overLimit += sched.overLimit();
    counters.peakFrameBytes = std::max(counters.peakFrameBytes, sched.peakFrameBytes());
    forget();
}

void Engine::forget() {
    lobes.clear();
    lobeRows_.clear();
    shadows.clear();
    traceSums_.clear();
    gathered_.clear();
    walks_.clear();
    below_.clear();
    ambients_.clear();
    litValues_.clear();
    waiting_.clear();
    moreLight_.clear();
    hemispheres_.clear();
    forgetRecordings();
    hitQueues_.clear();
    groupsWithHits_.clear();
    hitsWaiting_ = 0;
    extras_.clear();
    freeExtras_.clear();
}

bool Engine::traceAll(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stopFlag) {
    stop = stopFlag;
    unfinished_ = false;
    if (!rays.empty() && rays[0].depths) return seeThrough(rays, out);
    if (!sched_) sched_ = std::make_unique<Sched>(*this, stopFlag, limits::kFrameBytesPerThread, raysAtOnce_);
    Sched& sched = *sched_;
    sched.restart(stopFlag);
    size_t aovs = 0;
    for (int w : world_->outputWidths_) aovs += size_t(w);
    results.resize(rays.size());
    samples_.resize(rays.size());
    std::vector<TargetId> roots(rays.size());
    lightTargets_.clear();
    partTargets_.clear();
    shares_.clear();
    grids_ = false;
    rowsToRays_ = world_->accel_->takesRows() && !world_->unmade_ && world_->clippingPlanes_.empty() && !world_->shadesAtOpen_;
    nowhere_ = world_->lightOutputs_.empty() ? shading::kNoTarget : sched.newRoot();
    for (size_t i = 0; i < rays.size(); ++i) {
        const CameraRay& c = rays[i];
        out[i] = SampleResult{};
        out[i].aovs.assign(aovs, 0.f);
        grids_ |= c.grid != nullptr;
        results[i] = &out[i];
        roots[i] = sched.newRoot();
        for (size_t k = 0; k < world_->lightOutputs_.size(); ++k) lightTargets_.push_back(sched.newRoot());
        for (int k = 0; lightPaths_ && k < lightPaths_->parts(); ++k) partTargets_.push_back(sched.newRoot());
        PathRay& r = sched.spawn(0, roots[i]).payload;
        beginRay(c, i, r);
        if (lightPaths_) r.path = lightPaths_->begin();
    }
    counters.paths += rays.size();
    beginTrace();
    bool done = sched.run();
    if (done) keepRecordings(sched);
    float clampAt = world_->settings_.sampleClamp;
    for (size_t i = 0; i < rays.size(); ++i) {
        Color c = sched.value(roots[i]).radiance;
        float m = maxComponent(c);
        if (clampAt > 0 && m > clampAt) c *= clampAt / m; // pathtracer.md 6
        out[i].color = c;
        for (int k = 0; lightPaths_ && k < lightPaths_->parts(); ++k) {
            const Color part = sched.value(partTargets_[i * size_t(lightPaths_->parts()) + size_t(k)]).radiance;
            out[i].parts.push_back(clampAt > 0 && m > clampAt ? part * (clampAt / m) : part);
        }
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
    endTrace(sched);
    return done;
}

} // namespace alpenglow::transport

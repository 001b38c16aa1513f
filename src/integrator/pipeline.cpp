// The pipeline of a thread: its stages, trace() calls, and the way from slices of rays to shaded points.
#include "integrator/pipeline.h"
#include "base/memory.h"
#include "integrator/accumulator.h"
#include "integrator/ambientlight.h"
#include "integrator/atmosphere.h"
#include "integrator/batchpool.h"
#include "integrator/cameraoutputs.h"
#include "integrator/depthrays.h"
#include "integrator/displacement.h"
#include "integrator/emittedlight.h"
#include "integrator/gathercalls.h"
#include "integrator/guiderays.h"
#include "integrator/hitqueues.h"
#include "integrator/intersector.h"
#include "integrator/irradiancerecords.h"
#include "integrator/kernelinputs.h"
#include "integrator/lastskies.h"
#include "integrator/lightkernels.h"
#include "integrator/lightoutputs.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"
#include "integrator/nestedtrace.h"
#include "integrator/occlusioncalls.h"
#include "integrator/opacities.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/rowshading.h"
#include "integrator/segmentevents.h"
#include "integrator/shadowrays.h"
#include "integrator/subsurfacewalks.h"
#include "integrator/surfacepoints.h"
#include "integrator/surfaceshading.h"
#include "integrator/transparency.h"
#include "integrator/vertexblocks.h"
#include "integrator/vertexlight.h"
#include "integrator/waitingkernels.h"
#include "shading/gridpoint.h"
#include "world/mediaabout.h"
#include <algorithm>
#include <limits>

namespace alpenglow::integrator {

/// The stages, connected by `set`. Each is made after the stages that its constructor uses.
struct Pipeline::Parts {
    Parts(std::shared_ptr<const WorldImpl>, Diagnostics&, bool building);
    Context context;
    StageSet set;
    RayStore store;
    LightPathStates paths;
    Accumulator accumulator;
    Intersector intersector;
    HitQueues queues;
    SurfacePoints surfaces;
    SegmentEvents segmentEvents;
    EmittedLight emitted;
    LitSurfaces litSurfaces;
    Transparency transparency;
    LightKernels lightKernels;
    NestedTrace nested;
    MediumEvents mediumEvents;
    OcclusionCalls occlusion;
    IrradianceRecords records;
    GatherCalls gathers;
    GuideRays guide;
    ShadowRays shadows;
    Opacities opacities;
    MediaStacks media;
    Atmosphere atmosphere;
    BatchPool batches;
    KernelInputs inputs;
    Displacement displacement;
    VertexLight vertexLight;
    CameraOutputs cameraOutputs;
    SurfaceShading shading;
    RowShading rowShading;
    WaitingKernels waitingKernels;
    Requests requests;
    AmbientLight ambient;
    SubsurfaceWalks subsurface;
    PhotonStage photons;
    LightOutputs lightOutputs;
    DepthRays depthRays;
    LastSkies lastSkies;
};

Pipeline::Parts::Parts(std::shared_ptr<const WorldImpl> w, Diagnostics& d, bool building)
    : context(std::move(w), d, building),
      set{context,      store,         paths,        accumulator,  intersector,    queues,       surfaces,  segmentEvents,
          emitted,      litSurfaces,   transparency, lightKernels, nested,         mediumEvents, occlusion, records,
          gathers,      guide,         shadows,      opacities,    media,          atmosphere,   batches,   inputs,
          displacement, cameraOutputs, shading,      rowShading,   waitingKernels, requests,     ambient,   vertexLight,
          subsurface,   photons,       lightOutputs, depthRays,    lastSkies},
      store(set), paths(set), accumulator(set), intersector(set), queues(set), surfaces(set), segmentEvents(set), emitted(set),
      litSurfaces(set), transparency(set), lightKernels(set), nested(set), mediumEvents(set), occlusion(set), records(set),
      gathers(set), guide(set), shadows(set), opacities(set), media(set), atmosphere(set), batches(set), inputs(set),
      displacement(set), vertexLight(set), cameraOutputs(set), shading(set), rowShading(set), waitingKernels(set), requests(set),
      ambient(set), subsurface(set), photons(set), lightOutputs(set), depthRays(set), lastSkies(set) {
    const auto event = [](const Medium& m) { return m.homogeneous || m.priority != 0; };
    const WorldImpl& world = context.world;
    if (std::any_of(world.media().begin(), world.media().end(), event)) segmentEvents.happens(mediumEvents);
}

Pipeline::Pipeline(std::shared_ptr<const WorldImpl> w, Diagnostics& d, bool building)
    : parts_(std::make_unique<Parts>(std::move(w), d, building)) {}

Pipeline::~Pipeline() { // strips of an abandoned frame need their kernels
    parts_->nested.forget();
    sched_.reset();
}

const StageSet& Pipeline::stages() const { return parts_->set; }
const WorldImpl& Pipeline::world() const { return parts_->context.world; }
Counters& Pipeline::counters() { return parts_->context.counters; }
bool& Pipeline::unfinished() { return parts_->intersector.unfinished; }

Sched& Pipeline::scheduler() {
    const Context& c = parts_->context;
    if (!sched_) sched_ = std::make_unique<Sched>(*this, c.stop, limits::kFrameBytesPerThread, c.raysAtOnce);
    return *sched_;
}

bool Pipeline::withinRoom(const std::function<bool()>& run, const std::function<void()>& undo) {
    Context& c = parts_->context;
    while (true) {
        c.beginsAnew = c.raysAtOnce > 1;
        try {
            const bool done = run();
            c.beginsAnew = false;
            return done;
        } catch (const LimitReached&) { // results do not depend on how many points are shaded at a time
            if (!std::exchange(c.beginsAnew, false)) throw;
        }
        undo();
        c.raysAtOnce = std::max(1, c.raysAtOnce / 8);
        parts_->nested.forget();
        sched_.reset(); // suspended strips return memory that is freed next
        forget();
    }
}

bool Pipeline::trace(std::span<const CameraRay> rays, std::span<SampleResult> out, const StopFlag* stop) {
    const Counters before = counters();
    parts_->context.stop = stop;
    return withinRoom([&] { return traceAll(rays, out); }, [&] { counters() = before; });
}

/// Rays of orthographic cameras, lenses and stereo pairs do not start at the eye.
const shading::Media* Pipeline::mediaAtStart(const CameraRay& c) {
    const WorldImpl& w = world();
    if (c.origin == Vec3(0, 0, 0)) return w.eye().count ? &w.eye() : nullptr;
    return parts_->media.kept(mediaAbout(w, c.origin, w.shadesAtOpen() ? 0 : c.shutter));
}

void Pipeline::beginRay(const CameraRay& c, size_t i, PathRay& r) {
    const WorldImpl& w = world();
    r.origin = c.origin;
    r.dir = c.direction;
    PathSample& sample = parts_->store.samples[i];
    sample = {c.px,   c.py,      c.sample,
              int(i), c.time,    c.shutter,
              0.5f,   c.records, SampleNumbers(Sampler(parts_->context.seed, c.px, c.py), c.sample),
              c.grid};
    r.sample = &sample;
    r.footprint = {c.width, c.spread};
    r.setStart(c.start);
    if (!w.media().empty() && !c.grid) r.media = mediaAtStart(c);
    if (c.grid && c.grid->micropolygon) {
        // Sign-extends, as for pixels
        const auto half = [&](int shift) { return int(c.grid->micropolygon >> shift & 0x3fffffff) - (1 << 29); };
        sample.numbers = SampleNumbers(Sampler(parts_->context.seed, half(0), half(32)), c.sample);
    }
    if (w.fades()) sample.level = parts_->store.levelOf(c);
    r.counts = true;
}

void Pipeline::beginTrace() {
    parts_->accumulator.invalidSamples.clear();
    parts_->waitingKernels.waiting.clear();
    parts_->queues.clear();
}

void Pipeline::endTrace() {
    Counters& c = counters();
    c.nonFinite += sched_->nonFinite();
    c.overLimit += sched_->overLimit();
    c.peakFrameBytes = std::max(c.peakFrameBytes, sched_->peakFrameBytes());
    const Parts& p = *parts_;
    c.threadBytes = std::max(c.threadBytes, sched_->bytes() + p.queues.bytes() + p.batches.bytes() +
                                                p.vertexLight.stages().blocks.bytes() + p.shadows.bytes());
    forget();
}

void Pipeline::forget() {
    Parts& p = *parts_;
    p.requests.clear();
    p.shadows.clear();
    p.accumulator.traceSums.clear();
    p.gathers.gathered.clear();
    p.subsurface.clear();
    p.ambient.asked.clear();
    p.litSurfaces.values.clear();
    p.waitingKernels.waiting.clear();
    p.occlusion.hemispheres.clear();
    p.records.forget();
    p.queues.clear();
    p.store.forgetExtras();
}

bool Pipeline::traceAll(std::span<const CameraRay> rays, std::span<SampleResult> out) {
    const WorldImpl& w = world();
    Accumulator& sums = parts_->accumulator;
    parts_->intersector.unfinished = false;
    parts_->store.samples.resize(rays.size());
    if (!rays.empty() && rays[0].depths)
        return parts_->depthRays.seeThrough(rays, out, [&](const CameraRay& c, size_t i, PathRay& r) { beginRay(c, i, r); });
    Sched& sched = scheduler();
    sched.restart(parts_->context.stop);
    size_t aovs = 0;
    for (int width : w.widthsOfOutputs()) aovs += size_t(width);
    sums.begin(rays.size());
    sums.nowhere = w.lightOutputs().empty() ? shading::kNoAccumulator : sched.newRoot();
    parts_->intersector.begin(std::any_of(rays.begin(), rays.end(), [](const CameraRay& c) { return c.grid != nullptr; }));
    const scene::LightPaths* const paths = parts_->paths.automaton;
    std::vector<AccumulatorId> roots(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) {
        out[i] = SampleResult{};
        out[i].aovs.assign(aovs, 0.f);
        sums.results[i] = &out[i];
        roots[i] = sched.newRoot();
        for (size_t k = 0; k < w.lightOutputs().size(); ++k) sums.lightTargets.push_back(sched.newRoot());
        for (int k = 0; paths && k < paths->parts(); ++k) sums.partTargets.push_back(sched.newRoot());
        PathRay& r = sched.spawn(0, roots[i]).payload;
        beginRay(rays[i], i, r);
        if (paths) r.path = paths->begin();
    }
    counters().paths += rays.size();
    beginTrace();
    const bool done = sched.run();
    if (done) parts_->records.keep(sched);
    takeResults(out, roots);
    endTrace();
    return done;
}

/// Copies the light at the targets of camera samples to the results.
void Pipeline::takeResults(std::span<SampleResult> out, std::span<const AccumulatorId> roots) {
    const WorldImpl& w = world();
    const Accumulator& sums = parts_->accumulator;
    const scene::LightPaths* const paths = parts_->paths.automaton;
    const float clampAt = w.settings().sampleClamp;
    for (size_t i = 0; i < roots.size(); ++i) {
        Color c = sched_->value(roots[i]).radiance;
        float m = maxComponent(c);
        if (clampAt > 0 && m > clampAt) c *= clampAt / m; // --clamp, docs/noise.md
        out[i].color = c;
        for (int k = 0; paths && k < paths->parts(); ++k) {
            const Color part = sched_->value(sums.partTargets[i * size_t(paths->parts()) + size_t(k)]).radiance;
            out[i].parts.push_back(clampAt > 0 && m > clampAt ? part * (clampAt / m) : part);
        }
        for (size_t k = 0; k < w.lightOutputs().size(); ++k) {
            const LightOutputPlace& to = w.lightOutputs()[k];
            if (to.first < 0) continue;
            const Color light = sched_->value(sums.lightTargets[i * w.lightOutputs().size() + k]).radiance;
            if (to.size == 1) out[i].aovs[size_t(to.first)] += light.x + light.y + light.z;
            else
                for (int n = 0; n < 3; ++n) out[i].aovs[size_t(to.first + n)] += light[n];
        }
        Color& o = out[i].opacity;
        o = {std::min(o.x, 1.f), std::min(o.y, 1.f), std::min(o.z, 1.f)};
    }
    for (int i : sums.invalidSamples) out[size_t(i)].color = Color(std::numeric_limits<float>::quiet_NaN());
}

void Pipeline::follow(std::span<const Sched::Task> slice, Sched& sched) {
    Parts& p = *parts_;
    p.intersector.cast(slice);
    const std::vector<accel::Hit>& hits = p.intersector.hits;
    std::vector<const Sched::Task*> missed;
    for (size_t i = 0; i < slice.size(); ++i) {
        if (hits[i].valid() && p.context.seen) blocked(slice[i].payload, hits[i]);
        if (!hits[i].valid()) missed.push_back(&slice[i]);
        else if (p.guide.bringsNothing(slice[i].payload, world().bindingOf()[hits[i].shape])) p.store.freeExtra(slice[i].payload);
        else p.queues.add(slice[i], hits[i], sched);
    }
    p.segmentEvents.run(missed, sched);
    p.emitted.misses(missed, sched);
    for (const Sched::Task* t : missed) p.store.freeExtra(t->payload);
    // While kernels wait for rays no hits are held back: depth first keeps the number of frames small.
    const bool all = sched.frameBytes() > 0 || p.context.raysAtOnce < Context::kSlice;
    for (size_t g : p.queues.ready(all)) shadeHits(g, sched);
    while (p.queues.full()) shadeQueued(sched);
}

/// Notes a ray that may have seen a sky and met an opaque surface instead (Context::seen).
void Pipeline::blocked(const PathRay& r, const accel::Hit& h) {
    const SurfaceBinding& b = world().bindings()[size_t(world().bindingOf()[h.shape])];
    if (r.lobePdf >= 0 && b.opacityFor(r.kind->set.mode).opaque())
        parts_->context.seen->push_back({{r.lobeOrigin, r.dir}, SeenSample::kBlocked});
}

bool Pipeline::shadeQueued(Sched& sched) {
    if (parts_->queues.empty()) return false;
    shadeHits(parts_->queues.longest(), sched);
    return true;
}

void Pipeline::followStrips(Sched& sched) { parts_->waitingKernels.follow(sched); }

/// Processes the hits of a group: computes points, adds emission, runs the kernel.
void Pipeline::shadeHits(size_t group, Sched& sched) {
    Parts& p = *parts_;
    const WorldImpl& w = world();
    auto c = p.batches.take();
    c->extrasOf = &p.store;
    p.queues.take(group, *c);
    if (p.rowShading.takes(group) && p.rowShading.shade(*c, sched)) return p.batches.finish(std::move(c), sched);
    p.surfaces.placePoints(*c);
    p.segmentEvents.run(*c, sched);
    if (c->rays.empty()) return p.batches.giveBack(std::move(c));
    p.emitted.hits(*c, sched);
    p.store.keepIndirect(*c);
    if (w.globalMaps()) p.photons.takeGlobalMaps(*c, sched);
    if (c->rays.empty()) return p.batches.giveBack(std::move(c));
    if (p.shading.vanish(*c, sched)) return p.batches.finish(std::move(c), sched);
    if (p.photons.photonTrace()) p.photons.tilt(*c);
    c->again = p.photons.photonTrace() && p.photons.photonTrace()->job->learns;
    const bool same = std::all_of(c->bindings.begin(), c->bindings.end(), [&](int b) { return b == c->bindings[0]; });
    c->binding = &w.bindings()[size_t(c->bindings[0])];
    c->bound = group >= size_t(w.groups())            ? &w.primitiveHit()
               : same && !c->binding->usesObjectSpace ? &c->binding->surfaceS
                                                      : &c->binding->surfaceV;
    p.shading.shade(c, sched);
    p.batches.finish(std::move(c), sched);
}

} // namespace alpenglow::integrator

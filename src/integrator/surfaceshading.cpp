// Runs a surface's kernel over a batch of points, to its end or strip by strip if it waits for rays (strips.h); then interprets
// its requests.
#include "integrator/surfaceshading.h"
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/ambientlight.h"
#include "integrator/atmosphere.h"
#include "integrator/cameraoutputs.h"
#include "integrator/context.h"
#include "integrator/displacement.h"
#include "integrator/gathercalls.h"
#include "integrator/kernelinputs.h"
#include "integrator/lightoutputs.h"
#include "integrator/lightpathstates.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/transparency.h"
#include "integrator/vertex.h"
#include "integrator/vertexlight.h"
#include "integrator/waitingkernels.h"
#include "world/outputs.h"
#include <algorithm>

namespace alpenglow::integrator {

SurfaceShading::SurfaceShading(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), ambient_(s.ambient), atmosphere_(s.atmosphere),
      cameraOutputs_(s.cameraOutputs), displacement_(s.displacement), gathers_(s.gathers), inputs_(s.inputs),
      lightOutputs_(s.lightOutputs), paths_(s.paths), photons_(s.photons), store_(s.store), requests_(s.requests),
      shadows_(s.shadows), transparency_(s.transparency), vertexLight_(s.vertexLight), waitingKernels_(s.waitingKernels) {}

/// Writes results other than light to the call whose ray hit the point.
void SurfaceShading::answerCall(const BatchContext& c, int i, const Color& opacity, Sched& sched) {
    const PathRay& ray = c.rays[size_t(i)];
    const AccumulatorId target = c.targets[size_t(i)];
    if (ray.first) {
        sched.setNearer(target, length(c.points[size_t(i)].P - ray.origin), c.points[size_t(i)].N);
        sched.setTransmission(target, Color(1) - opacity);
    }
    if (!gathers_.gathered.empty())
        if (const auto asks = gathers_.gathered.find(target); asks != gathers_.gathered.end())
            gathers_.answerGather(c, i, *asks->second);
    const RayExtra& extra = store_.extraOf(ray);
    if (extra.fade.fades() && maxComponent(extra.environment) > 0) { // the sky shows through partial blocking
        const Color light = extra.whole * extra.environment * opacity * (1 - extra.kept);
        accumulator_.contribute(sched, {target, light, LightEvent::Map, &ray, extra.share});
        if (TraceSums* sums = accumulator_.sumsOf(target)) sums->add(TraceSums::Environment, light);
    }
    if (TraceSums* sums = accumulator_.sumsOf(target)) {
        const Color blocked = extra.part * opacity * extra.kept;
        sums->add(TraceSums::Blocked, blocked);
        sums->add(TraceSums::Open, ray.dir * -mean(blocked));
    }
}

void SurfaceShading::finish(BatchContext& c, int first, int lanes, Sched& sched, std::span<const uint32_t> asked) {
    if (c.lightOutput) return lightOutputs_.finishLightOutputs(c, first, lanes, sched);
    shading::Batch& b = *c.batch;
    int ci = b.plan().Ci, oi = b.plan().Oi;
    cameraOutputs_.begin(c);
    bool suspended = b.kernel().facts().suspends; // then the atmosphere has not run yet
    const bool media = !world_.media().empty();
    if (suspended) atmosphere_.atmosphereOfBatch(c, first, lanes, media || paths_.automaton);
    for (int i = first; i < std::min(first + lanes, int(c.points.size())); ++i) {
        const PathRay& ray = c.rays[i];
        const SurfaceBinding& binding = world_.bindings()[c.bindings[i]];
        Color color = ci >= 0 ? b.color(ci, i) : Color(0), opacity = oi >= 0 ? b.color(oi, i) : Color(1);
        if (binding.matte && ray.camera()) {
            sched.setDistance(c.targets[i], 0);
            color = Color(0);
        }
        answerCall(c, i, opacity, sched);
        Color shown = color;
        if (!c.atmosphereEffects.empty() && c.atmosphereEffects[size_t(i)].on &&
            !(binding.matte && ray.camera())) { // shade() has scaled the pairs
            shown = c.atmosphereEffects[size_t(i)].shown;
            opacity = c.atmosphereEffects[size_t(i)].opacity;
        }
        if (!isFinite(opacity)) accumulator_.notFinite(&ray, "Oi", binding.surface.get());
        const bool hazed = !c.atmosphereEffects.empty() &&
                           c.atmosphereEffects[size_t(i)].on; // then light of the surface and of the volume are separated
        if (isFinite(shown))
            accumulator_.contribute(sched,
                                    {c.targets[i], ray.weight * shown, LightEvent::Surface, &ray, store_.extraOf(ray).share,
                                     binding.surface.get(), hazed ? uint16_t(0) : paths_.next(ray.path, paths_.object)});
        else accumulator_.notFinite(&ray, "Ci", binding.surface.get());
        if (hazed && ray.path && isFinite(shown))
            accumulator_.contributeThroughVolume(
                sched, ray, binding.matte && ray.camera() ? shown : c.atmosphereEffects[size_t(i)].slope * color, shown);
        if (ray.counts) {
            cameraOutputs_.seeNormal(ray, c.points[size_t(i)], opacity);
            cameraOutputs_.see(ray, opacity, c.depths.empty() ? c.points[size_t(i)].P.z : c.depths[size_t(i)], binding.matte);
            cameraOutputs_.add(c, i);
        }
        const float chance = c.passes.empty() ? 1 : c.passes[size_t(i)];
        const Color clear = chance > 0 && !c.opaque ? transparency_.goesOn(c, i) : Color(0);
        if (ray.counts && ray.sample->grid) accumulator_.results[size_t(ray.sample->path)]->behind = clear;
        else if (maxComponent(clear) > 0) {
            if (PhotonTrace* const t = photons_.photonTrace(); t && !t->probes.empty())
                t->ends[size_t(ray.sample->path)].chance *= chance;
            transparency_.continueBehind(binding, ray, c.targets[i], c.points[i], clear, chance,
                                         asked.empty() ? 0 : asked[size_t(i - first)], sched);
        }
    }
}

bool SurfaceShading::vanish(BatchContext& c, Sched& sched) {
    const auto nothing = [&](int b) {
        const SurfaceBinding& s = world_.bindings()[size_t(b)];
        return s.vanishes && s.lightOutputs.empty() && s.inLightOutputs.empty();
    };
    if (!std::all_of(c.bindings.begin(), c.bindings.end(), nothing) || photons_.photonTrace() || !gathers_.gathered.empty() ||
        !accumulator_.traceSums.empty())
        return false;
    const bool outputs = world_.settings().firstSeen || !world_.wanted().empty();
    for (const PathRay& r : c.rays) {
        const bool reported = (r.first && !(r.counts && sched.plain())) || (r.counts && (outputs || r.sample->grid));
        const bool inAtmosphere = r.medium() >= 0 && !world_.media()[size_t(r.medium())].homogeneous;
        if (reported || inAtmosphere || store_.extraOf(r).fade.fades()) return false;
    }
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const PathRay& r = c.rays[i];
        if (r.counts) cameraOutputs_.see(r, Color(0), c.depths.empty() ? c.points[i].P.z : c.depths[i], false);
        transparency_.continueBehind(world_.bindings()[size_t(c.bindings[i])], r, c.targets[i], c.points[i], Color(1), 1, 0,
                                     sched);
    }
    return true;
}

void SurfaceShading::shade(const std::shared_ptr<BatchContext>& c, Sched& sched) {
    if (c->binding->displacement) displacement_.take(*c);
    const auto& kernel = *c->bound->kernel;
    if (photons_.photonTrace()) atmosphere_.atmosphereOfPhotons(*c);
    if (photons_.photonTrace() && kernel.facts().suspends) return photons_.photonsByModel(*c, sched);
    inputs_.fill(*c);
    if (c->displaced) c->batch->takeDisplacement(*c->displaced->batch);
    gathers_.takeSent(*c->batch, c->targets, rsl::PairName::To::Surface);
    auto outputBatches = lightOutputs_.lightOutputBatches(*c, sched);
    if (c->binding->moveS) displacement_.moveToFacets(*c); // the kernel moves P itself: it starts with the undisplaced surface
    const int n = int(c->points.size());
    counters_.points += uint64_t(n);
    ++counters_.batches;
    counters_.lanesUsed += uint64_t(n);
    counters_.lanesRun += uint64_t((n + kernel.lanes() - 1) / kernel.lanes() * kernel.lanes());

    if (kernel.facts().suspends) {
        waitingKernels_.start(c, sched);
        lightOutputs_.followLightOutputs(lightOutputs_.shareLight(*c, {}, outputBatches, sched), outputBatches, sched);
        return;
    }
    kernel.run(&c->batch->call());
    c->ran();

    // Atmospheres scale the requests of the kernel.
    const bool media = !world_.media().empty();
    const bool inAtmosphere =
        !photons_.photonTrace() && (media || std::any_of(c->bindings.begin(), c->bindings.end(), [&](int b) {
                                        return world_.bindings()[size_t(b)].atmosphere.shader != nullptr;
                                    }));
    if (inAtmosphere) {
        atmosphere_.atmosphereOfBatch(*c, 0, n, media || !c->emits.empty() || paths_.automaton);
        atmosphere_.scaleRequests(*c);
    }
    if (outputBatches.empty() && vertexLight_.takes(*c)) {
        c->opaque = !photons_.photonTrace() && isOpaque(*c->batch); // those see the opacity of their shading models
        if (!c->opaque && rules_.pickOne) transparency_.setTransparency(*c);
        if (vertexLight_.run(*c, sched)) {
            counters_.inRows += uint64_t(n);
            requests_.requestPairs(*c, nullptr, sched, false);
            if (!ambient_.asked.empty()) ambient_.gather(*c);
            shadows_.flush(sched);
            return finish(*c, 0, n, sched);
        }
    }
    std::vector<AskedLobe> asked; // only if outputs share lobes
    requests_.requestPairs(*c, outputBatches.empty() ? nullptr : &asked, sched);
    if (world_.settings().hider == Hider::Path) transparency_.setTransparency(*c);
    const auto rest = lightOutputs_.shareLight(*c, asked, outputBatches, sched);
    vertexLight_.gather(*c, sched);
    shadows_.flush(sched);
    finish(*c, 0, n, sched);
    lightOutputs_.followLightOutputs(rest, outputBatches, sched);
}

} // namespace alpenglow::integrator

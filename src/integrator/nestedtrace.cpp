#include "integrator/nestedtrace.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/gatherrows.h"
#include "integrator/litsurfaces.h"
#include "integrator/medium.h"
#include "integrator/pipeline.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/segmentevents.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/waitingkernels.h"

namespace alpenglow::integrator {

NestedTrace::NestedTrace(const StageSet& s)
    : Stage(s.context), mediumEvents_(s.mediumEvents), accumulator_(s.accumulator), segmentEvents_(s.segmentEvents) {}

NestedTrace::~NestedTrace() = default;

void NestedTrace::forget() { inner_.reset(); }

const StageSet& NestedTrace::begin() {
    if (!inner_) {
        inner_ = std::make_unique<Pipeline>(context_.frame, diagnostics_, context_.building);
        for (SegmentEvent* e : segmentEvents_.events)
            if (e != &mediumEvents_) inner_->stages().segmentEvents.happens(*e); // it has its own
        inner_->stages().context.raysAtOnce = std::min(context_.raysAtOnce, int(Sched::kStripRays));
    }
    const StageSet& s = inner_->stages();
    s.context.stop = context_.stop;
    s.context.beginsAnew = context_.beginsAnew;
    inner_->scheduler().restart(context_.stop);
    s.waitingKernels.waiting.clear();
    s.accumulator.traceSums.clear();
    s.gathers.gathered.clear();
    s.requests.clear();
    return s;
}

void NestedTrace::takeCounts() {
    const StageSet& s = inner_->stages();
    counters_ += s.context.counters;
    s.context.counters = {};
    accumulator_.invalidSamples.insert(accumulator_.invalidSamples.end(), s.accumulator.invalidSamples.begin(),
                                       s.accumulator.invalidSamples.end());
    s.accumulator.invalidSamples.clear();
}

shading::TargetValue NestedTrace::trace(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& row,
                                        uint32_t occurrence) {
    const shading::TargetValue value = follow(c, s, point, row, occurrence);
    takeCounts();
    return value;
}

shading::TargetValue NestedTrace::follow(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& row,
                                         uint32_t occurrence) {
    const ShadePoint& p = c.points[size_t(point)];
    const PathRay& from = *p.ray;
    const StageSet& in = begin();
    Sched& sched = inner_->scheduler();
    const AccumulatorId target = sched.newRoot();
    // request() reads rows of lanes; this is a single lane.
    std::vector<float> rows;
    for (int r = 0; r < rowsOfArguments(s); ++r) rows.push_back(row(r));
    in.requests.request(c, s, point, rows.data(), 1, 0, Color(1), target, true, occurrence);
    if (in.requests.lobes.empty()) return {};
    LobeVertex l = in.requests.lobes.back();
    in.requests.lobes.clear();
    if (from.bounces + 1 > world_.maxDepth()) return {};
    uint32_t many = from.asked;
    float chance = 1;
    const bool onlyDistance = s.givesDistance() && s.resultRows.size() < 2;
    if (rules_.roulette && !onlyDistance) {
        many = std::max<uint32_t>(many, uint32_t(world_.lightTraces()) * (occurrence + 1) * uint32_t(std::max(l.samples, 1)));
        chance = rouletteOfLight(from.bounces, many);
        const uint32_t vertex = childVertex(from.vertex, kLightPoint + l.site, occurrence * 4096);
        if (chance < 1 && in.store.random(from).one(vertex, kRoulette, 0) >= chance) return {};
    }
    const Vec3 start = l.ownOrigin ? l.from : p.P;
    const bool leaves = p.lit && length(start - p.Ps) <= geometry::roundingError(p.Ps) + 4 * p.lit->pError;
    in.requests.rows.prepare();
    const BsdfBatch::Place place = l.place;
    const bool delta = in.requests.rows.delta(place);
    const float spread = in.requests.rows.spread(place);
    if (delta) l.samples = 1;
    const uint32_t drawn = childVertex(from.vertex, kLightPoint + l.site, occurrence * 4096);
    for (int k = 0; k < l.samples; ++k) {
        const uint32_t nth = occurrence * 4096 + uint32_t(k), vertex = childVertex(from.vertex, kLightPoint + l.site, nth);
        Vec3 w;
        const Random ofDraw = in.store.random(from).draw(uint32_t(k), uint32_t(l.samples));
        int tries = 0;
        const int most = l.trace->axis ? kDrawTries : 1;
        do {
            in.requests.rows.ask(place, tries ? in.store.random(from).pair(vertex, kDrawAgain, uint32_t(tries))
                                              : ofDraw.pair(drawn, l.site, occurrence));
            in.requests.rows.sample();
        } while (!in.requests.rows.drawn(place, w) && ++tries < most);
        if (tries == most) continue;
        in.requests.rows.ask(place, w);
        in.requests.rows.evaluate();
        const LobeValue value = in.requests.rows.value(place);
        const Color f = delta ? Color(in.requests.rows.albedo(place)) : value.pdf > 0 ? value.colour / value.pdf : Color(0);
        PathRay r = from;
        r.weight = f / float(l.samples);
        r.vertex = vertex;
        r.asked = uint16_t(std::min<uint32_t>(many, 0xffff));
        r.bounces = int16_t(onlyDistance ? world_.maxDepth() : from.bounces + 1); // a distance query ends at the first hit
        ++(l.rays->type == RayType::Diffuse ? r.diffuseBounces : r.specularBounces);
        r.origin = l.bias >= 0 ? start + w * l.bias
                   : leaves    ? geometry::offsetOrigin(*p.lit, w, 0)
                               : start + w * geometry::roundingError(start);
        r.crossedMedium = r.passed = false, r.trail = 0, r.path = 0; // its light belongs to the light's kernel
        if (!leaves || (dot(from.dir, p.lit->n) < 0) != (dot(w, p.lit->n) > 0)) r.media = nullptr; // the media there are unknown
        r.dir = w;
        r.maxDistance = l.maxDistance;
        r.kind = l.rays;
        RayExtra extra;
        if (l.trace && l.trace->map) extra.environment = l.tint * in.requests.mapTowards(*l.trace, w, from.footprint.spread);
        r.extra = in.store.newExtra(extra);
        r.lobePdf = -1, r.lobeBinding = -1; // no light was sampled: emission counts in full
        r.first = true, r.counts = false;
        r.footprint.spread = std::max(from.footprint.spread, spread * 0.5f);
        sched.spawn(r.bounces + r.layers, target, r);
    }
    in.requests.rows.clear();
    sched.run();
    in.litSurfaces.values.clear();
    in.shadows.queue.clear();
    // The probability is not in the weights of the rays: at their hits they continue as if it were 1.
    shading::TargetValue value = sched.value(target);
    value.radiance = value.radiance / chance;
    return value;
}

void NestedTrace::gather(std::span<GatherSent> sent) {
    const StageSet& in = begin();
    Sched& sched = inner_->scheduler();
    std::vector<AccumulatorId> targets;
    for (GatherSent& g : sent) {
        targets.push_back(sched.newRoot());
        in.gathers.gathered[targets.back()] = &g;
        sched.spawn(g.ray.bounces + g.ray.layers, targets.back(), g.ray);
    }
    sched.run();
    for (size_t k = 0; k < sent.size(); ++k)
        if (!sent[k].quiet) endGatherRay(*sent[k].site, sched.value(targets[k]), sent[k].row);
    in.gathers.gathered.clear();
    in.litSurfaces.values.clear();
    in.shadows.queue.clear();
    takeCounts();
}

} // namespace alpenglow::integrator

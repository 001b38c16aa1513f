// Stage ScatterRays: rays of lobes. With Rules::pickOne one lobe of a vertex is followed, else all.
#include "integrator/scatterrays.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/guiderays.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/lobeselection.h"
#include "integrator/mediastacks.h"
#include "integrator/photonscatter.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/subsurfacewalks.h"
#include "world/emitterfootprint.h"

namespace alpenglow::integrator {

ScatterRays::ScatterRays(const StageSet& s, const VertexLobes& v, LobeSelection& selection, PhotonScatter& photonScatter)
    : VertexStage(s, v), selection_(selection), photonScatter_(photonScatter), accumulator_(s.accumulator), guide_(s.guide),
      paths_(s.paths), media_(s.media), photons_(s.photons), subsurface_(s.subsurface), unshadowed_(s) {}

void ScatterRays::run(Sched& sched) {
    sent.clear();
    numbers_.clear();
    for (size_t point = 0; point < c_->points.size(); ++point)
        if (picks(point)) numbers_.askOne(store_.random(c_->rays[point]).numbers(), c_->rays[point].vertex, kChooseLobe, 0);
    numbers_.draw();
    size_t number = 0;
    for (size_t point = 0; point < c_->points.size(); ++point)
        if (begin_[point] != begin_[point + 1]) pick(point, picks(point) ? numbers_.one(number++) : 0);
    int turns = 0;
    for (const LobeRay& s : sent) turns = std::max(turns, s.count);
    for (int turn = 0; turn < turns; ++turn) { // one ray for each lobe
        draw(turn);
        if (photons_.photonTrace()) photonScatter_.lookBack(sched);
        throwDice(turn);
        for (const LobeRay& s : sent)
            if (s.goes) sendRay(s, sched);
    }
}

/// Whether the continuation of a point is chosen at random.
bool ScatterRays::picks(size_t point) const {
    const int lobes = begin_[point + 1] - begin_[point];
    return rules_.pickOne && lobes > 0 && (lobes > 1 || selection_.passes[point] < 1);
}

/// `number`: the random number, if picks().
void ScatterRays::pick(size_t point, float number) {
    const auto list = lobesOf(point);
    const bool mayPass = selection_.passes[point] < 1; // lobes have the remaining probability
    if (list.size() == 1 && !mayPass) {                // the most frequent case
        const LobeVertex& l = requests_.lobes[size_t(list[0])];
        if (!(l.chosen > 0) || !l.followed) return;
        const bool one = rules_.pickOne && !l.ownsTarget;
        sent.push_back({int(point), list[0], one ? 1 : l.samples, one ? 1 / l.chosen : 1, true, Vec3(), {}});
        return;
    }
    float sum = 0;
    bool taken = false;
    for (int i : list) {
        const LobeVertex& l = requests_.lobes[size_t(i)];
        if (!(l.chosen > 0)) continue;
        float scale = 1;
        int count = l.samples;
        if (rules_.pickOne && !l.ownsTarget) {
            sum += l.chosen;
            if (taken || (number >= sum && (mayPass || i != list.back()))) continue;
            taken = true;
            scale = 1 / l.chosen;
            count = 1;
        }
        if (!l.followed) continue;
        sent.push_back({int(point), i, count, scale, true, Vec3(), {}});
    }
    if (mayPass) c_->passes[point] = taken ? 0 : selection_.passes[point];
}

/// Samples directions for the rays of one iteration and evaluates their lobes.
void ScatterRays::draw(int turn) {
    BsdfBatch& rows = requests_.rows;
    numbers_.clear();
    for (LobeRay& s : sent) {
        s.goes = turn < s.count;
        s.again = s.idle = false;
        if (!s.goes) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        const PathRay& from = c_->rays[size_t(s.point)];
        numbers_.askPair(store_.random(from).draw(uint32_t(turn), uint32_t(s.count)).numbers(), from.vertex, l.site,
                         l.occurrence * 4096);
    }
    numbers_.draw();
    size_t number = 0;
    for (LobeRay& s : sent) {
        if (!s.goes) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        Vec2 u = numbers_.pair(number++);
        const std::optional<Vec3> w = l.beside.draw(u);
        if ((s.drawn = w.has_value())) s.w = *w;
        else rows.ask(l.place, u);
    }
    rows.sample();
    bool again = false;
    for (LobeRay& s : sent) {
        if (!s.goes || s.drawn) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        s.goes = rows.drawn(l.place, s.w);
        again |= s.again = !s.goes && !l.delta && l.trace && (l.trace->axis || (l.trace->openness && l.ownsTarget));
        s.idle = s.again && !l.trace->axis;
    }
    if (again) drawAgain(turn);
    for (const LobeRay& s : sent)
        if (const LobeVertex& l = requests_.lobes[size_t(s.lobe)]; s.goes && !l.delta) rows.ask(l.place, s.w);
    rows.evaluate();
    for (LobeRay& s : sent) {
        if (!s.goes) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        s.value = l.delta ? LobeValue{Color(l.albedo), l.albedo, 0} : rows.value(l.place);
        s.value.pdf = l.beside.density(s.w, s.value.pdf);
        if (s.idle) s.value.colour = Color(0);
    }
}

void ScatterRays::drawAgain(int turn) {
    BsdfBatch& rows = requests_.rows;
    for (int tries = 1; tries < kDrawTries; ++tries) {
        numbers_.clear();
        for (const LobeRay& s : sent) {
            if (!s.again) continue;
            const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
            const uint32_t vertex = childVertex(rayOf(l).vertex, l.site, l.occurrence * 4096 + uint32_t(turn));
            numbers_.askPair(store_.random(rayOf(l)).numbers(), vertex, kDrawAgain, uint32_t(tries));
        }
        if (numbers_.size() == 0) return;
        numbers_.draw();
        size_t number = 0;
        for (const LobeRay& s : sent)
            if (s.again) rows.ask(requests_.lobes[size_t(s.lobe)].place, numbers_.pair(number++));
        rows.sample();
        for (LobeRay& s : sent)
            if (s.again) s.again = !(s.goes = rows.drawn(requests_.lobes[size_t(s.lobe)].place, s.w));
    }
}

/// Sets the random number keys of the rays of one iteration and draws their roulette numbers.
void ScatterRays::throwDice(int turn) {
    numbers_.clear();
    for (LobeRay& s : sent) {
        if (!s.goes) continue;
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        const PathRay& from = rayOf(l);
        s.vertex = childVertex(from.vertex, l.site, l.occurrence * 4096 + uint32_t(turn));
        if (rules_.roulette && (l.ownsTarget || from.bounces + 1 > 3))
            numbers_.askOne(store_.random(from).numbers(), s.vertex, kRoulette, 0);
    }
    numbers_.draw();
    size_t number = 0;
    for (LobeRay& s : sent)
        if (const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
            s.goes && rules_.roulette && (l.ownsTarget || rayOf(l).bounces + 1 > 3))
            s.dice = numbers_.one(number++);
}

/// A ray that carries emission only is useless if it misses the bounding spheres of all emitters.
bool ScatterRays::intersectsEmitter(const LobeVertex& l, const Vec3& w) const {
    if (!l.lights) return false;
    const Vec3& from = l.elsewhere ? l.from : c_->points[size_t(l.point)].P;
    const float error = 1e-3f * (1 + length(from)) + std::fabs(l.bias);
    if (world_.lights_.size() > 64) return true; // sending the ray costs less than testing all of them
    for (const BoundLight& light : world_.lights_) {
        if (light.kind != LightKind::Area || !light.emitter || light.emitter->empty()) continue;
        const Vec3 to = light.centre - from;
        const float along = std::max(dot(to, w), 0.f), reach = light.radius * 1.001f + error;
        const Vec3 beside = to - w * along;
        if (!(dot(beside, beside) > reach * reach)) return true;
    }
    return false;
}

float ScatterRays::roulette(const LobeVertex& l, const LobeRay& s, uint16_t& asked, const Color& weight) const {
    const PathRay& from = rayOf(l);
    const auto dice = [&] { return s.dice; };
    float q = 1;
    if (l.ownsTarget) {
        asked = uint16_t(std::min<uint32_t>(std::max<uint32_t>(from.asked, l.before + uint32_t(s.count)), 0xffff));
        q = rouletteWaiting(from.bounces, from.asked, l.before, uint32_t(s.count));
        if (q < 1 && dice() >= q) q = 0;
    } else if (world_.settings_.localRoulette) {
        q = rouletteLocal(from.bounces + 1, l.weight, from.bounces + 1 > 3 ? dice() : 0);
    } else if (from.bounces + 1 > 3) {
        // A light that traces sends rays at every vertex: throughput ends this tree of rays.
        const Color left(std::fabs(weight.x), std::fabs(weight.y), std::fabs(weight.z));
        q = world_.lightTraces_ > 0 ? rouletteLocal(from.bounces + 1, left, dice()) : rouletteOfPath(weight, dice);
    }
    return std::max(q, 0.f);
}

UnshadowedRay ScatterRays::unshadowedRay(const LobeVertex& l, const Vec3& w) const {
    const Vec3& from = l.elsewhere ? l.from : c_->points[size_t(l.point)].P;
    return {l.point, l.rays, origin(l, w), w, l.maxDistance, l.lights && (l.elsewhere || l.delta), from, l.lit};
}

void ScatterRays::sendRay(const LobeRay& s, Sched& sched) {
    const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
    const ShadePoint& p = c_->points[size_t(s.point)];
    const PathRay& from = c_->rays[size_t(s.point)];
    Vec3 w = s.w;
    const PhotonTrace* photon = photons_.photonTrace();
    if (photon && p.shape->oneSided() && !(dot(w, intersectsNormal(p.surface)) > 0)) return; // invisible from there
    if (!photon && l.trace && l.trace->onlyLights && !(l.base > 0) && !intersectsEmitter(l, w)) return;
    const float pdf = s.value.pdf;
    const Color f = l.delta ? s.value.colour : pdf > 0 ? s.value.colour / pdf : Color(0);
    RayExtra extra;
    extra.indirect = (l.lobeOfShader && l.below < 0 ? selection_.indirectScale[size_t(s.point)] : 1) * l.indirect;
    const float scale = photon ? s.scale * std::exchange(extra.indirect, 1.f) : s.scale;
    const Color through = l.narrow && photon ? s.back : l.weight * (f * (scale / float(s.count)));
    if (!photon && l.trace && l.trace->map) extra.environment = l.tint * requests_.mapTowards(*l.trace, w, from.footprint.spread);
    if (TraceSums* of = !photon && l.trace && l.trace->sums ? accumulator_.sumsOf(l.target) : nullptr)
        unshadowed_.add(*c_, unshadowedRay(l, w), through, extra.environment, *of);
    Color weight = l.ownsTarget ? through : from.weight * through;
    if (photon) weight *= leftOfPhoton(*c_, size_t(s.point)) * photonScatter_.photonWay(l, w);
    if (!isFinite(weight)) return accumulator_.notFinite(*c_, from, l.site);
    if (weight == Color(0) && !l.ownsTarget) return;
    uint16_t asked = from.asked;
    const float q = rules_.roulette ? roulette(l, s, asked, weight) : 1;
    if (!(q > 0)) return;
    weight = weight / q;
    if (l.below >= 0) {
        const float indirect = l.lobeOfShader ? selection_.indirectScale[size_t(s.point)] : 1;
        subsurface_.walks.push_back({s.point, l.below, weight, l.target, s.vertex, shareOf(l), indirect});
        return;
    }
    const int bounces = from.bounces + 1;
    PathRay& r = sched.spawn(bounces + from.layers, l.target, from).payload;
    r.weight = weight;
    r.vertex = s.vertex;
    r.asked = asked;
    if (photon)
        if (const auto depths = photonScatter_.depthsBehind(l, world_.bindings_[size_t(c_->bindings[size_t(s.point)])]))
            depths->to(r);
    r.bounces = int16_t(bounces);
    r.scattered = int16_t(from.scattered + c_->between);
    ++(l.rays->type == RayType::Diffuse ? r.diffuseBounces : r.specularBounces);
    r.origin = origin(l, w);
    if (l.base > 0) { // anywhere in the footprint
        const Vec2 at = store_.random(from).pair(s.vertex, kSampleBase, 0);
        r.origin += (p.surface.dPdu * (p.du * (at.x - .5f)) + p.surface.dPdv * (p.dv * (at.y - .5f))) * l.base;
    }
    r.dir = w;
    r.path = paths_.atLobe(l, p, from, w);
    r.maxDistance = l.maxDistance;
    r.kind = !photon ? l.rays : store_.kindOf(l.rays->type == RayType::Diffuse ? photon->diffuse : photon->specular);
    r.trail = photonScatter_.trailBehind(l);
    r.media = media_.towards(*c_, s.point, w);
    r.parted = r.passed = false;
    r.importance *= l.importance;
    if (l.rays->type == RayType::Specular && l.rays->label == context_.totalReflection) ++counters_.totalReflected;
    else if (l.rays->type == RayType::Specular)
        ++(dot(w, p.surface.n) * dot(from.dir, p.surface.n) > 0 ? counters_.refracted : counters_.reflected);
    extra.lit = l.lit;
    extra.fade = l.fade;
    if (c_->between && world_.scatters_) extra.flown = c_->flown[size_t(l.point)];
    extra.share = shareOf(l);
    if (l.ownsTarget && l.trace && l.trace->sums) {
        extra.part = Color(1.f / (float(s.count) * q));
        if (TraceSums* of = accumulator_.sumsOf(l.target)) of->add(TraceSums::Open, w * mean(extra.part));
    }
    r.extra = store_.newExtra(extra);
    // If its lobe samples lights, emission that it hits is weighted by MIS.
    const bool sampled = l.lights && !l.elsewhere && !l.delta;
    r.lobePdf = sampled && rules_.lightsAtRequests ? (rules_.pickOne || l.ownsTarget ? pdf * l.chosen : pdf) : -1;
    if (guide_.on() && PhotonScatter::mirrorsPath(l)) r.lobePdf = guide_.pdfBehindMirror(from);
    r.lobeOrigin = p.P;
    r.lobeBinding = sampled || (photon && !c_->between) ? c_->bindings[size_t(s.point)] : -1;
    r.footprint = from.footprint.after(length(p.P - from.origin));
    r.footprint.spread = spreadBehind(from, requests_.rows.spread(l.place));
    r.counts = false;
    r.first = l.ownsTarget;
    counters_.depthMax = std::max(counters_.depthMax, bounces);
    ++counters_.depthSum; // over camera rays: mean number of bounces
}

} // namespace alpenglow::integrator

// Stage Connection: evaluates lobes for light samples. The lobes of a vertex share the sample of a light, so one shadow ray
// carries the light of all of them.
#include "integrator/connection.h"
#include "base/direction.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsampling.h"
#include "integrator/lobeselection.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"
#include "integrator/raystore.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "world/emitterfootprint.h"

namespace alpenglow::integrator {

Connection::Connection(const StageSet& s, const VertexLobes& v, LightSampling& lightSampling)
    : VertexStage(s, v), lightSampling_(lightSampling), accumulator_(s.accumulator), paths_(s.paths), media_(s.media),
      mediumEvents_(s.mediumEvents), shadows_(s.shadows) {}

void Connection::connect() {
    reached_.clear();
    lastQuery_ = -1;
    for (size_t k = 0; k < lightSampling_.queries.count; ++k) {
        const LightValue& v = lightSampling_.queries.value[k];
        if (v.lit && !isFinite(v.Cl))
            accumulator_.notFinite(&c_->rays[size_t(lightSampling_.queries.point[k])], "Cl",
                                   lightSampling_.queries.light[k]->instance.get());
        else if (v.lit && v.Cl != Color(0)) reach(int(k));
    }
    evaluate();
    for (const Reached& r : reached_) send(r);
}

/// Evaluates the lobes for the samples that reach them, in rounds with each lobe at most once.
void Connection::evaluate() {
    turns_.assign(requests_.lobes.size(), 0);
    int turns = 0;
    for (Reached& r : reached_) {
        r.turn = turns_[size_t(r.lobe)]++;
        turns = std::max(turns, r.turn + 1);
    }
    for (int turn = 0; turn < turns; ++turn) {
        for (const Reached& r : reached_)
            if (r.turn == turn) requests_.rows.ask(requests_.lobes[size_t(r.lobe)].place, r.w);
        requests_.rows.evaluate();
        for (Reached& r : reached_)
            if (r.turn == turn) r.value = requests_.rows.value(requests_.lobes[size_t(r.lobe)].place);
    }
}

/// Collects the lobes that the sample of a query reaches.
void Connection::reach(int query) {
    const LightQueries& q = lightSampling_.queries;
    const size_t k = size_t(query);
    const BoundLight& light = *q.light[k];
    const bool area = light.kind == LightKind::Area;
    const Vec3 w = area || light.isSky() ? q.drawn[k].direction : directionOr(-q.value[k].L, Vec3(0, 0, 1));
    for (int i : lobesOf(size_t(q.point[k]))) {
        const LobeVertex& l = requests_.lobes[size_t(i)];
        if (!lightSampling_.samples(l, light) || q.draw[k].nth >= lightSampling_.lightSamples(l)) continue;
        if (q.spread[k] >= 0 && q.spread[k] != spreadBehind(rayOf(l), requests_.rows.spread(l.place))) continue;
        // Sides 1: rays of this lobe pass through the emitter from its back, so it sends nothing there.
        const accel::Sides sides = l.rays->set.sides;
        if (area && !light.mean && q.drawn[k].shape->oneSided() && sides != accel::Sides::Both &&
            (dot(intersectsNormal(q.at[k].surface), w) >= 0) != (sides == accel::Sides::Back))
            continue;
        reached_.push_back({query, i, 0, w, {}});
    }
}

/// Whether a ray of trace() could hit a light sample: within its distance, in its set of shapes, on a side that it can hit.
bool Connection::intersects(const LobeVertex& l, int query, const Vec3& w, const Vec3& from, const Vec3& end) const {
    const geometry::Shape& shape = *lightSampling_.queries.drawn[size_t(query)].shape;
    const shading::RaySet& set = l.rays->set;
    if (set.only && !set.only[world_.numberOfShape_.at(&shape)]) return false;
    if (shape.oneSided() && set.sides != accel::Sides::Both &&
        (dot(intersectsNormal(lightSampling_.queries.at[size_t(query)].surface), w) >= 0) != (set.sides == accel::Sides::Back))
        return false;
    const Vec3 way = end - from;
    return dot(way, w) > 0 && !(length(way) > l.maxDistance);
}

/// Light that a lobe reflects from the sample, before occlusion.
Color Connection::contribution(const Reached& r) {
    const LobeVertex& l = requests_.lobes[size_t(r.lobe)];
    const size_t k = size_t(r.query);
    const BoundLight& light = *lightSampling_.queries.light[k];
    const LightValue& v = lightSampling_.queries.value[k];
    const bool area = light.kind == LightKind::Area;
    const float fcos = r.value.fcos, drawn = lightSampling_.queries.drawn[k].pdf, chance = lightSampling_.queries.chance[k];
    const float kept = l.lobeOfShader || !light.hasDensity() ? v.kept(l.rays->type) : 1;
    Color c = l.ownsTarget ? l.weight * v.Cl : l.weight * rayOf(l).weight * v.Cl;
    c *= r.value.colour / (fcos * float(lightSampling_.lightSamples(l))); // the lobe's weight counts once for all its rays
    if (area && l.trace && l.trace->sums)
        if (TraceSums* of = accumulator_.sumsOf(l.target)) of->add(TraceSums::UnshadowedAreaLight, c * (fcos / (drawn * chance)));
    if (c_->between) c *= mediumEvents_.shareOfDistance(c_->flown[size_t(l.point)], light);
    if (!light.hasDensity()) return c * (kept * float(kPi) * fcos / (chance * (area ? drawn : 1))); // Cl is irradiance / pi
    float other = 0; // density of this direction by the lobe's own sampling
    if (!world_.settings_.lightOnly && l.chosen > 0 && (lightSampling_.queries.drawn[k].visibility & visibilityBit(l.rays->type)))
        other = l.beside.density(r.w, r.value.pdf) * l.chosen;
    const float pdf = drawn * chance;
    return c * (kept * fcos / pdf * misWeight(pdf, other));
}

void Connection::send(const Reached& r) {
    const LobeVertex& l = requests_.lobes[size_t(r.lobe)];
    const PathRay& ray = rayOf(l);
    if (std::isnan(r.value.fcos)) accumulator_.notFinite(*c_, ray, l.site);
    if (!(r.value.fcos > 0)) return;
    const size_t k = size_t(r.query);
    const BoundLight& light = *lightSampling_.queries.light[k];
    const bool area = light.kind == LightKind::Area, sums = l.trace && l.trace->sums;
    const Vec3 from = origin(l, r.w);
    // The light's own surface must not occlude: stop before it by both error bounds.
    const Vec3 end = area ? leavesFrom(lightSampling_.queries.at[k].surface, -r.w) : Vec3();
    if (l.trace && area && !intersects(l, r.query, r.w, from, end)) return;
    const float away = light.kind == LightKind::Distant ? 1e38f : length(lightSampling_.queries.value[k].L);
    if (l.trace && !area && !light.isSky() && light.kind != LightKind::Distant && away > l.maxDistance) return;
    const Color given = contribution(r);
    const int32_t share = shareOf(l);
    const uint16_t path = paths_.atLobe(l, c_->points[size_t(l.point)], ray, r.w);
    const RayKind* kind = l.trace ? store_.kindOf({RayType::Transmission, false, l.rays->set, 0}) : &kShadowKind;
    const bool shares = !(light.isSky() && l.maxDistance < 1e37f); // others see the sky farther
    if (shares && r.query == lastQuery_)
        if (ShadowRay& last = shadows_.queue.back(); last.kind == kind && last.origin == from) {
            shadows_.more.push_back({given, l.target, share, sums, path, last.more});
            last.more = int32_t(shadows_.more.size()) - 1;
            return;
        }
    lastQuery_ = r.query;
    const ShadePoint& p = c_->points[size_t(l.point)];
    if (area) {
        shadows_.queue.push_back(
            {from, normalizeOr(end - from, r.w), length(end - from) * (1 - 1e-6f), given, l.target, p.shutter, p.ray, sums});
    } else {
        // A ray of trace() sees the sky also behind geometry beyond its distance.
        const float far = light.isSky() ? l.maxDistance : away;
        shadows_.queue.push_back(
            {from, r.w, far < 1e30f && !light.isSky() ? far * (1 - 1e-5f) : far, given, l.target, p.shutter, p.ray, false});
        if (const float radius = lightSampling_.queries.value[k].shadowRadius; radius > 0) {
            const uint32_t use = kLightPoint + uint32_t(&light - world_.lights_.data());
            const Vec2 u = store_.random(ray).pair(lightVertex(size_t(l.point)), use, 0);
            const Vec3 to =
                onShadowDisk(lightSampling_.queries.at[k].Ps - lightSampling_.queries.value[k].L, r.w, radius, u) - from;
            shadows_.queue.back().dir = normalizeOr(to, r.w);
            shadows_.queue.back().distance = length(to) * (1 - 1e-5f);
        }
    }
    ShadowRay& shadow = shadows_.queue.back();
    shadow.kind = kind;
    shadow.media = media_.towards(*c_, l.point, r.w);
    shadow.share = share;
    shadow.path = path;
    if (path) shadow.light = paths_.lights[size_t(&light - world_.lights_.data())];
    // Not occluded: light loops and trace() with "samplelights" under the other hiders, and lights whose shader computed
    // visibility.
    const bool asInLoops = c_->below || (l.trace && !area && !light.isSky());
    if ((asInLoops && !rules_.pickOne && !light.shadows) || lightSampling_.queries.value[k].ownShadow) shadow.distance = 0;
}

} // namespace alpenglow::integrator

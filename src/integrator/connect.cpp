// Stage connect: what lobes give back of the light that lights send them. Lobes of a vertex share the sample of a light, and so
// the way to it: one shadow ray carries what all of them give.
#include "base/direction.h"
#include "integrator/gather.h"
#include "integrator/medium.h"
#include "lobes/sampling.h"
#include "world/emitterfootprint.h"

namespace alpenglow::transport {

void Gather::connect() {
    reached_.clear();
    lastQuery_ = -1;
    for (size_t k = 0; k < queries_.count; ++k) {
        const LightValue& v = queries_.value[k];
        if (v.lit && !isFinite(v.Cl)) e_.notFinite(&c_->rays[size_t(queries_.point[k])], "Cl", queries_.light[k]->instance.get());
        else if (v.lit && v.Cl != Color(0)) reach(int(k));
    }
    evaluate();
    for (const Reached& r : reached_) send(r);
}

/// The values of the lobes for the light that reaches them: in turns, in which each lobe is asked once.
void Gather::evaluate() {
    turns_.assign(e_.lobes.size(), 0);
    int turns = 0;
    for (Reached& r : reached_) {
        r.turn = turns_[size_t(r.lobe)]++;
        turns = std::max(turns, r.turn + 1);
    }
    for (int turn = 0; turn < turns; ++turn) {
        for (const Reached& r : reached_)
            if (r.turn == turn) e_.lobeRows_.ask(e_.lobes[size_t(r.lobe)].place, r.w);
        e_.lobeRows_.evaluate();
        for (Reached& r : reached_)
            if (r.turn == turn) r.value = e_.lobeRows_.value(e_.lobes[size_t(r.lobe)].place);
    }
}

/// Notes the lobes that the light of a query reaches.
void Gather::reach(int query) {
    const LightQueries& q = queries_;
    const size_t k = size_t(query);
    const BoundLight& light = *q.light[k];
    const bool area = light.kind == LightKind::Area;
    const Vec3 w = area || light.sky ? q.drawn[k].direction : directionOr(-q.value[k].L, Vec3(0, 0, 1));
    for (int i : lobesOf(size_t(q.point[k]))) {
        const LobeVertex& l = e_.lobes[size_t(i)];
        if (!samples(l, light) || q.draw[k].nth >= lightSamples(l)) continue;
        if (q.spread[k] >= 0 && q.spread[k] != spreadBehind(rayOf(l), e_.lobeRows_.spread(l.place))) continue;
        // Sides 1: from where rays of this lobe pass through the emitter they cannot meet it, and it sends nothing.
        const accel::Sides sides = l.rays->set.sides;
        if (area && !light.mean && q.drawn[k].shape->oneSided() && sides != accel::Sides::Both &&
            (dot(meetsNormal(q.at[k].surface), w) >= 0) != (sides == accel::Sides::Back))
            continue;
        reached_.push_back({query, i, 0, w, {}});
    }
}

/// A light sample of trace() finds what a ray of it could meet there: within its distance, of its set, from the sides that it
/// meets.
bool Gather::meets(const LobeVertex& l, int query, const Vec3& w, const Vec3& from, const Vec3& end) const {
    const geometry::Shape& shape = *queries_.drawn[size_t(query)].shape;
    const shading::RaySet& set = l.rays->set;
    if (set.only && !set.only[world_.numberOfShape_.at(&shape)]) return false;
    if (shape.oneSided() && set.sides != accel::Sides::Both &&
        (dot(meetsNormal(queries_.at[size_t(query)].surface), w) >= 0) != (set.sides == accel::Sides::Back))
        return false;
    const Vec3 way = end - from;
    return dot(way, w) > 0 && !(length(way) > l.maxDistance);
}

/// What a lobe gives back of the light, before what stands between.
Color Gather::contribution(const Reached& r) {
    const LobeVertex& l = e_.lobes[size_t(r.lobe)];
    const size_t k = size_t(r.query);
    const BoundLight& light = *queries_.light[k];
    const LightValue& v = queries_.value[k];
    const bool area = light.kind == LightKind::Area;
    const float fcos = r.value.fcos, drawn = queries_.drawn[k].pdf, chance = queries_.chance[k];
    const float kept = l.lobeOfShader ? v.kept(l.rays->type) : 1;
    Color c = l.ownsTarget ? l.weight * v.Cl : l.weight * rayOf(l).weight * v.Cl;
    c *= r.value.colour / (fcos * float(lightSamples(l))); // as many rays go along the lobe: of its weight n is no matter
    if (area && l.trace && l.trace->sums)
        if (TraceSums* of = e_.sumsOf(l.target)) of->add(TraceSums::UnshadowedAreaLight, c * (fcos / (drawn * chance)));
    if (c_->between) c *= MediumFlights::shareOfDistance(e_, c_->flown[size_t(l.point)], light);
    if (!light.hasDensity()) return c * (kept * float(kPi) * fcos / (chance * (area ? drawn : 1))); // Cl is irradiance / pi
    float other = 0; // the density with which the lobe's own ray would have come here
    if (!world_.settings_.lightOnly && l.chosen > 0 && (queries_.drawn[k].visibility & visibilityBit(l.rays->type)))
        other = densityBeside(l, r.w, r.value.pdf) * l.chosen;
    const float pdf = drawn * chance;
    return c * (kept * fcos / pdf * misWeight(pdf, other));
}

void Gather::send(const Reached& r) {
    const LobeVertex& l = e_.lobes[size_t(r.lobe)];
    const PathRay& ray = rayOf(l);
    if (std::isnan(r.value.fcos)) e_.notFinite(*c_, ray, l.site);
    if (!(r.value.fcos > 0)) return;
    const size_t k = size_t(r.query);
    const BoundLight& light = *queries_.light[k];
    const bool area = light.kind == LightKind::Area, sums = l.trace && l.trace->sums;
    const Vec3 from = origin(l, r.w);
    // The light's own surface must not block: stop short of it by both error bounds.
    const Vec3 end = area ? leavesFrom(queries_.at[k].surface, -r.w) : Vec3();
    if (l.trace && area && !meets(l, r.query, r.w, from, end)) return;
    const Color given = contribution(r);
    const int32_t share = shareOf(l);
    const uint16_t path = e_.atLobe(l, c_->points[size_t(l.point)], ray, r.w);
    const RayKind* kind = l.trace ? e_.kindOf({RayType::Transmission, false, l.rays->set, 0}) : &kShadowKind;
    if (r.query == lastQuery_)
        if (ShadowRay& last = e_.shadows.back(); last.kind == kind && last.origin == from) {
            e_.moreLight_.push_back({given, l.target, share, sums, path, last.more});
            last.more = int32_t(e_.moreLight_.size()) - 1;
            return;
        }
    lastQuery_ = r.query;
    const ShadePoint& p = c_->points[size_t(l.point)];
    if (area) {
        e_.shadows.push_back(
            {from, normalizeOr(end - from, r.w), length(end - from) * (1 - 1e-6f), given, l.target, p.shutter, p.ray, sums});
    } else {
        // A ray of trace() sees the sky behind what lies beyond its distance, too.
        const float far = light.sky ? l.maxDistance : light.kind == LightKind::Distant ? 1e38f : length(queries_.value[k].L);
        e_.shadows.push_back(
            {from, r.w, far < 1e30f && !light.sky ? far * (1 - 1e-5f) : far, given, l.target, p.shutter, p.ray, false});
        if (const float radius = queries_.value[k].shadowRadius; radius > 0) {
            const uint32_t use = kLightPoint + uint32_t(&light - world_.lights_.data());
            const Vec2 u = e_.random(ray).pair(lightVertex(size_t(l.point)), use, 0);
            const Vec3 to = onShadowDisk(queries_.at[k].Ps - queries_.value[k].L, r.w, radius, u) - from;
            e_.shadows.back().dir = normalizeOr(to, r.w);
            e_.shadows.back().distance = length(to) * (1 - 1e-5f);
        }
    }
    ShadowRay& shadow = e_.shadows.back();
    shadow.kind = kind;
    shadow.media = e_.mediaTowards(*c_, l.point, r.w);
    shadow.share = share;
    shadow.path = path;
    if (path) shadow.light = e_.lightSymbols_[size_t(&light - world_.lights_.data())];
    // As in light loops there, nothing is in the way; or the light's shader looked for itself.
    if ((c_->below && !rules_.pickOne && !light.shadows) || queries_.value[k].ownShadow) shadow.distance = 0;
}

} // namespace alpenglow::transport

// Light sampling for vertices in blocks, and the lobes' response.
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/blockphotons.h"
#include "integrator/chosenlights.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsample.h"
#include "integrator/mediastacks.h"
#include "integrator/ownshadows.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/surfacepoints.h"
#include "integrator/vertexlight.h"
#include "world/emitterfootprint.h"
#include <algorithm>
#include <bit>
#include <numeric>

namespace alpenglow::integrator {

void BlockVertices::light(BatchContext& c, Sched& sched) {
    if (!rules_.lightsAtRequests) return;
    several_ = drawsSeveral();
    if (paths_.automaton) surfaces_.pointsOfRows(c); // needed to tell reflection from transmission
    const WorldImpl::LightList& list = world_.lightLists_[size_t(c.binding->lightList)];
    if (choosesLights(list)) {
        findLit(nullptr);
        if (!litBlocks_.empty()) chosen_->light(list, c, sched);
        return;
    }
    for (const int number : world_.sampledOf(list)) {
        if (list.ofAll && !list.lights.contains(number)) continue;
        const BoundLight& light = world_.lights_[size_t(number)];
        findLit(&light);
        if (c.between) takeParts(light, c);
        if (!litBlocks_.empty()) lightAlone(light, c, sched);
    }
    for (const int number : world_.skies_) {
        const BoundLight& light = world_.lights_[size_t(number)];
        if (!light.guidable || !rules_.pickOne || waits_ || c.between || !guideOf(world_, light) || !list.lights.contains(number))
            continue;
        findLit(&light);
        if (!litBlocks_.empty()) lightAlone(light, c, sched);
    }
}

/// Whether each point samples some of the lights of a list, instead of all.
bool BlockVertices::choosesLights(const WorldImpl::LightList& list) const {
    return rules_.pickOne && !(world_.chooserOf(list).empty() && list.deeper.empty());
}

/// Finds the points that sample a light; null: any light.
void BlockVertices::findLit(const BoundLight* light) {
    lit_.assign(blocks_, 0);
    for (size_t k = 0; k < count_; ++k)
        for (size_t b = 0; b < blocks_ && sites_[k].lights; ++b)
            lit_[b] |= light ? litBy(k, b, *light) : sites_[k].lobes[b].lights;
    litBlocks_.clear();
    for (size_t b = 0; b < blocks_; ++b)
        if (lit_[b]) litBlocks_.push_back(b);
}

/// Points whose lobe samples a light. The light guide completes rays, so its skies need lobes that send some.
Lanes BlockVertices::litBy(size_t site, size_t b, const BoundLight& light) const {
    if ((onlySite_ >= 0 && onlySite_ != int(site)) || !samples(sites_[site], light)) return 0;
    const LobeBlock& l = sites_[site].lobes[b];
    Lanes some = l.lights & ~gathered_->bring(l, light);
    for (int i = 0; light.guidable && i < kBlock; ++i) some &= ~(Lanes(!(l.chosen[i] > 0)) << i);
    for (Lanes left = draw_ > 0 ? some : 0; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left));
        if (draw_ >= uint32_t(drawsOf(sites_[site], b * kBlock + i))) some &= ~(1u << i);
    }
    return some;
}

/// Takes one sample of a light for the points of lit_ and litBlocks_.
void BlockVertices::lightOnce(const BoundLight& light, BatchContext& c) {
    if (isWide(light) && onlySite_ < 0) return lightWide(light, c);
    checksHits_ = checksHits(light);
    if (inRows_[numberOf(light)] && !checksHits_) return lightInRows(light, c);
    sampleLight(light, c);
    if (asked_.empty()) return;
    askQueries(light, nullptr, {}, c);
    takeValues(light, c);
    connect(light, c);
}

/// Samples an emitter that filters over its surface, for one call site after the other: their lobes differ in width.
void BlockVertices::lightWide(const BoundLight& light, BatchContext& c) {
    for (size_t k = 0; k < count_; ++k) {
        onlySite_ = int(k);
        findLit(&light);
        if (c.between) takeParts(light, c);
        if (!litBlocks_.empty()) lightOnce(light, c);
    }
    onlySite_ = -1;
}

/// Whether lobes of a call site sample a light. trace() without "samplelights" samples emitters and skies only; it samples none
/// that illuminance loops handle.
bool BlockVertices::samples(const Site& s, const BoundLight& light) const {
    if (!light.importance && (!s.lighting || rules_.emissionCounts)) return false; // only rays find it
    if (!s.lights || s.lighting) return s.lights;
    return (light.kind == LightKind::Area || light.isSky() || s.info->allLights) && light.strategy != LightStrategy::Illuminance;
}

/// Chooses a point on the light for a lit one. Returns false if the sample carries no light.
bool BlockVertices::placeQuery(const BoundLight& light, const LightGuide* guide, const LightNumbers& u, const ShadePoint& lit,
                               ShadePoint& q, Emitter::Sample& s) const {
    tellLit(q, lit);
    if (!placeLightSample(world_, light, guide, u, rules_.pickOne, q, s)) return false;
    // Sides 1: rays pass through the emitter from its back, so it sends nothing there.
    return checksHits_ || light.kind != LightKind::Area || light.mean || !s.shape->oneSided() ||
           dot(intersectsNormal(q.surface), s.direction) < 0;
}

/// Chooses a point on the light for each point that samples it.
void BlockVertices::sampleLight(const BoundLight& light, BatchContext& c) {
    const uint32_t use = kLightPoint + numberOf(light);
    const bool pair = takesPair(light, rules_.pickOne);
    if (pair) drawOf(light, use << 1, pairs_);
    if (takesChoice(light)) drawOf(light, use << 1 | render::SampleNumbers::kSingle, choices_);
    const LightGuide* const guide = c.between || !rules_.pickOne ? nullptr : guideOf(world_, light);
    asked_.clear();
    surfaces_.pointsOfRows(c);
    for (size_t b = 0; b < blocks_; ++b)
        for (Lanes left = lit_[b]; left; left &= left - 1) {
            const int lane = std::countr_zero(left), point = int(b) * kBlock + lane;
            if (asked_.size() == queries_.size()) queries_.emplace_back(); // queries of the previous light are overwritten
            ShadePoint& q = queries_[asked_.size()];
            BlockQuery& a = asked_.emplace_back();
            a.point = point;
            LightNumbers u;
            if (pair) u.pair = {pairs_[b].x[lane], pairs_[b].y[lane]};
            if (takesChoice(light)) u.choose = choices_[b].x[lane];
            const ShadePoint& at = c.points[size_t(point)];
            const bool placed = placeQuery(light, guide, u, at, q, a.sample);
            if (!placed) asked_.pop_back();
            else if (onlySite_ >= 0) // isWide()
                setEmitterFootprint(
                    q, c.rays[size_t(point)], at.P,
                    spreadBehind(c.rays[size_t(point)], sites_[size_t(onlySite_)].lobes[b].lobe[kRowSpread][lane]));
        }
    queries_.resize(asked_.size());
}

/// Makes room for the light's radiance; zero at first.
void BlockVertices::beginLights(const BoundLight& light) {
    lights_.resize(blocks_);
    for (LightBlock& l : lights_) {
        l.asked = l.metDiffuse = l.metSpecular = 0;
        l.emitter = light.kind == LightKind::Area;
        l.met = light.hasDensity();
    }
}

/// Copies the light at the points into rows.
void BlockVertices::takeValues(const BoundLight& light, const BatchContext& c) {
    beginLights(light);
    queryAt_.resize(points_);
    for (size_t k = 0; k < asked_.size(); ++k) {
        const LightValue& value = values_[k];
        const BlockQuery& a = asked_[k];
        if (value.lit && !isFinite(value.Cl)) accumulator_.notFinite(&c.rays[size_t(a.point)], "Cl", light.instance.get());
        else if (value.lit && value.Cl != Color(0)) {
            takeValue(lights_[size_t(a.point / kBlock)], a.point % kBlock, light, value, queries_[k], a.sample);
            queryAt_[size_t(a.point)] = int32_t(k);
        }
    }
}

/// Copies the radiance from one point on a light into a lane.
void BlockVertices::takeValue(LightBlock& l, int lane, const BoundLight& light, const LightValue& value, const ShadePoint& query,
                              const Emitter::Sample& sample) {
    const bool drawn = l.emitter || light.isSky();
    const Vec3 w = drawn ? sample.direction : directionOr(-value.L, Vec3(0, 0, 1));
    const Vec3 end = l.emitter ? leavesFrom(query.surface, -w) : Vec3();
    for (int q = 0; q < 3; ++q) l.w[q][lane] = w[q], l.Cl[q][lane] = value.Cl[q], l.end[q][lane] = end[q];
    l.density[lane] = drawn ? sample.pdf : 1;
    const float far = light.isSky() || light.kind == LightKind::Distant ? 1e38f : length(value.L);
    l.far[lane] = far < 1e30f ? far * (1 - 1e-5f) : far;
    l.keptDiffuse[lane] = value.kept(RayType::Diffuse);
    l.keptSpecular[lane] = value.kept(RayType::Specular);
    l.asked |= 1u << lane;
    l.metDiffuse |= Lanes((sample.visibility & visibilityBit(RayType::Diffuse)) != 0) << lane;
    l.metSpecular |= Lanes((sample.visibility & visibilityBit(RayType::Specular)) != 0) << lane;
}

void BlockVertices::connect(const BoundLight& light, BatchContext& c) {
    for (size_t b = 0; b < blocks_; ++b)
        if (lights_[b].asked) connectBlock(b, light, c);
}

/// Evaluates the lobes of a call site at `points` for their lights, into value_; adds the result to shadow rays that were already
/// sent. pointOf: by lane, index in the batch. Returns the lanes whose ray is still to be sent.
Lanes BlockVertices::contribute(const Site& s, const VertexBlock& points, const LobeBlock& lobe, LightBlock& l, BatchContext& c,
                                const size_t* pointOf) {
    Lanes failed = 0, fresh = 0;
    for (size_t i = 0; several_ && i < size_t(kBlock); ++i) draws_[i] = float(drawsOf(s, pointOf[i]));
    l.draws = several_ ? draws_ : nullptr; // the lobe's weight counts once for all of them
    s.addLightDirected(lobe.lights & l.asked, l.w, pointOf, value_[kRowPdf]);
    const float* kept = !s.lighting && l.met ? whole_ : s.diffuse ? l.keptDiffuse : l.keptSpecular;
    const Lanes met = world_.settings_.lightOnly ? 0 : s.diffuse ? l.metDiffuse : l.metSpecular;
    Lanes some = stages_.contribute(points, lobe, l, kept, met, !s.lighting, value_[0], shadow_, &failed);
    for (; failed; failed &= failed - 1) accumulator_.notFinite(c, c.rays[pointOf[std::countr_zero(failed)]], uint32_t(s.number));
    const bool sums = !s.lighting && s.info->trace->sums;
    if (sums && l.emitter) sumUnshadowed(s, points, lobe, l, some, c, pointOf);
    for (; some; some &= some - 1) {
        const int lane = std::countr_zero(some);
        if (sent_[lane] < 0) {
            fresh |= 1u << lane;
            continue;
        }
        ShadowRay& first = shadows_.queue[size_t(sent_[lane])];
        const Color light{shadow_.light[0][lane], shadow_.light[1][lane], shadow_.light[2][lane]};
        const uint16_t path = pathOf(s, false, pointOf[lane], {l.w[0][lane], l.w[1][lane], l.w[2][lane]}, c);
        shadows_.more.push_back(
            {light, c.targets[pointOf[lane]], shareOf(s, pointOf[lane], c.rays[pointOf[lane]]), sums, path, first.more});
        first.more = int32_t(shadows_.more.size()) - 1;
    }
    return fresh;
}

/// Makes the shadow rays of a block: one per point, for all of its lobes.
void BlockVertices::connectBlock(size_t b, const BoundLight& of, BatchContext& c) {
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    const BoundLight* lights[kBlock];
    std::fill_n(lights, kBlock, &of);
    LightBlock& l = lights_[b];
    l.parted = c.between; // takeParts()
    stages_.aim(vertices_[b], l, shadow_);
    std::fill_n(sent_, kBlock, -1);
    const Lanes placed = l.asked;
    for (size_t k = 0; k < count_; ++k) {
        const Site& s = sites_[k];
        const LobeBlock& lobe = s.lobes[b];
        l.asked = litBy(k, b, of) & placed;
        OwnShadows own(*this, s);
        own.limit(s, points, lights, checksHits_ ? queryAt_.data() + b * kBlock : nullptr, l);
        const Lanes asked = l.asked;
        if (asked) s.lanes->evaluate(lobe.lobe[0], asked, l.w[0], value_[0]);
        for (Lanes some = contribute(s, vertices_[b], lobe, l, c, points); some; some &= some - 1) {
            const size_t lane = size_t(std::countr_zero(some)), point = b * kBlock + lane;
            const int32_t query = queryAt_.empty() ? -1 : queryAt_[point];
            sendShadow(s, point, lane, {l.w[0][lane], l.w[1][lane], l.w[2][lane]}, of,
                       query < 0 ? nullptr : &values_[size_t(query)], c);
            if (of.hasDensity() && !c.between) {
                const VertexBlock& v = vertices_[b];
                const float light = luminance(Color(l.Cl[0][lane], l.Cl[1][lane], l.Cl[2][lane])), pdf = l.density[lane];
                shadows_.note({{{v.P[0][lane], v.P[1][lane], v.P[2][lane]},
                                {l.w[0][lane], l.w[1][lane], l.w[2][lane]},
                                light,
                                light / pdf,
                                pdf},
                               int(&of - world_.lights_.data())});
            }
        }
    }
}

/// RayExtra::share of the continuing ray.
int32_t BlockVertices::shareOf(const Site& s, size_t point, const PathRay& r) const {
    if (waits_) return -1;
    const LobeVertex* const request = s.requestAt(point);
    return request && request->share >= 0 ? request->share : store_.extraOf(r).share;
}

uint16_t BlockVertices::pathOf(const Site& s, bool delta, size_t point, const Vec3& w, const BatchContext& c) const {
    if (waits_ || !paths_.automaton) return 0;
    return paths_.atLobe(*s.kind, s.raysAt(point), delta, c.points[point], c.rays[point], w);
}

/// Sends the shadow ray of a lane of shadow_, from a point toward w; says: shadow parameters of the light, or null.
void BlockVertices::sendShadow(const Site& site, size_t point, size_t lane, const Vec3& w, const BoundLight& of,
                               const LightValue* says, BatchContext& c) {
    const auto row3 = [&](const Row* r) { return Vec3(r[0][lane], r[1][lane], r[2][lane]); };
    sent_[lane] = int32_t(shadows_.queue.size());
    ShadowRay& s = shadows_.queue.emplace_back();
    s = {row3(shadow_.origin), row3(shadow_.direction), shadow_.length[lane],
         row3(shadow_.light),  c.targets[point],        world_.shadesAtOpen_ ? 0 : c.rays[point].shutter(),
         &c.rays[point]};
    s.share = shareOf(site, point, c.rays[point]);
    const bool emitter = of.kind == LightKind::Area;
    if (site.sets) s.kind = store_.kindOf({RayType::Transmission, false, site.raysAt(point).set, 0});
    s.areaLight = emitter && !site.lighting && site.info->trace->sums;
    if (!world_.media_.empty()) s.media = media_.towards(c, int(point), w);
    s.path = pathOf(site, false, point, w, c);
    if (s.path) s.light = paths_.lights[numberOf(of)];
    // Under the other hiders, light loops and trace() with "samplelights" let lights without "shadows" through.
    const bool asInLoops = !rules_.pickOne && (c.below || (!site.lighting && !emitter && !of.isSky()));
    if (says && says->shadowRadius > 0) { // to a point on the disk
        const VertexBlock& v = vertices_[point / kBlock];
        const uint32_t use = kLightPoint + numberOf(of), vertex = v.lightVertex[point % kBlock];
        const Vec2 u = store_.random(c.rays[point]).pair(vertex, use, 0);
        const Vec3 P(v.P[0][point % kBlock], v.P[1][point % kBlock], v.P[2][point % kBlock]);
        const Vec3 to = onShadowDisk(P - says->L, s.dir, says->shadowRadius, u) - s.origin;
        s.dir = normalizeOr(to, s.dir);
        s.distance = length(to) * (1 - 1e-5f);
    }
    // Not occluded; or the light's shader computed visibility itself.
    if ((asInLoops && !of.shadows) || (says && says->ownShadow)) s.distance = 0;
}

} // namespace alpenglow::integrator

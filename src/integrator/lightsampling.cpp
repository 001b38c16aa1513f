// Light sampling at vertices: which lights, and points on them.
#include "base/direction.h"
#include "integrator/accumulator.h"
#include "integrator/chosenlights.h"
#include "integrator/connection.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsample.h"
#include "integrator/medium.h"
#include "integrator/photongather.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"
#include "services/random.h"
#include "world/emitterfootprint.h"
#include <algorithm>
#include <bit>

namespace alpenglow::integrator {

LightSampling::LightSampling(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), accumulator_(s.accumulator), batches_(s.batches), connection_(v.connection), gathered_(v.gather),
      inputs_(s.inputs), lightKernels_(s.lightKernels), litSurfaces_(s.litSurfaces), media_(s.media),
      mediumEvents_(s.mediumEvents), paths_(s.paths), store_(s.store), shadows_(s.shadows), surfaces_(s.surfaces) {
    if (!world_.canTrace()) return; // not a complete world
    for (const BoundLight& l : world_.lights()) inRows_.push_back(inRows(l, l.kernel));
    chosen_ = std::make_unique<ChosenLights>(*this, s, v);
}

LightSampling::~LightSampling() = default;

void LightSampling::run(BatchContext& c, Sched& sched) {
    if (!rules_.lightsAtRequests) return;
    given_.clear();
    v_.several = drawsSeveral();
    if (paths_.automaton) surfaces_.pointsOfRows(c); // needed to tell reflection from transmission
    const WorldImpl::LightList& list = world_.lightLists()[size_t(c.binding->lightList)];
    if (choosesLights(list)) {
        findLit(nullptr);
        if (!v_.litBlocks.empty()) chosen_->light(list, c, sched);
        return;
    }
    for (const int number : world_.sampledOf(list)) {
        if (list.ofAll && !list.lights.contains(number)) continue;
        const BoundLight& light = world_.lights()[size_t(number)];
        findLit(&light);
        if (c.between) takeParts(light, c);
        if (!v_.litBlocks.empty()) lightAlone(light, c, sched);
    }
    for (const int number : world_.skies()) {
        const BoundLight& light = world_.lights()[size_t(number)];
        if (!light.guidable || !rules_.pickOne || v_.waits || c.between || !guideOf(world_, light) ||
            !list.lights.contains(number))
            continue;
        findLit(&light);
        if (!v_.litBlocks.empty()) lightAlone(light, c, sched);
    }
}

/// Whether each point samples some of the lights of a list, instead of all.
bool LightSampling::choosesLights(const WorldImpl::LightList& list) const {
    return rules_.pickOne && !(world_.chooserOf(list).empty() && list.deeper.empty());
}

/// Finds the points that sample a light; null: any light.
void LightSampling::findLit(const BoundLight* light) {
    v_.lit.assign(v_.blocks, 0);
    for (size_t k = 0; k < v_.count; ++k)
        for (size_t b = 0; b < v_.blocks && v_.sites[k].lights; ++b)
            v_.lit[b] |= light ? litBy(k, b, *light) : v_.sites[k].lobes[b].lights;
    v_.litBlocks.clear();
    for (size_t b = 0; b < v_.blocks; ++b)
        if (v_.lit[b]) v_.litBlocks.push_back(b);
}

/// Points whose lobe samples a light. The light guide completes rays, so its skies need lobes that send some.
Lanes LightSampling::litBy(size_t site, size_t b, const BoundLight& light) const {
    if ((v_.onlySite >= 0 && v_.onlySite != int(site)) || !samples(v_.sites[site], light)) return 0;
    const LobeBlock& l = v_.sites[site].lobes[b];
    Lanes some = l.lights & ~gathered_.bring(l, light);
    for (int i = 0; light.guidable && i < kBlock; ++i) some &= ~(Lanes(!(l.chosen[i] > 0)) << i);
    for (Lanes left = v_.draw > 0 ? some : 0; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left));
        if (v_.draw >= uint32_t(drawsOf(v_.sites[site], b * kBlock + i))) some &= ~(1u << i);
    }
    return some;
}

/// Takes one sample of a light for the points of v_.lit and v_.litBlocks.
void LightSampling::lightOnce(const BoundLight& light, BatchContext& c) {
    if (isWide(light) && v_.onlySite < 0) return lightWide(light, c);
    v_.checksHits = checksHits(light);
    if (inRows_[v_.numberOf(light)] && !v_.checksHits) {
        askInRows(light, c);
        return connection_.connect(light, c);
    }
    sampleLight(light, c);
    if (v_.asked.empty()) return;
    askQueries(light, nullptr, {}, c);
    takeValues(light, c);
    connection_.connect(light, c);
}

/// Samples an emitter that filters over its surface, for one call site after the other: their lobes differ in width.
void LightSampling::lightWide(const BoundLight& light, BatchContext& c) {
    for (size_t k = 0; k < v_.count; ++k) {
        v_.onlySite = int(k);
        findLit(&light);
        if (c.between) takeParts(light, c);
        if (!v_.litBlocks.empty()) lightOnce(light, c);
    }
    v_.onlySite = -1;
}

/// Whether lobes of a call site sample a light. trace() without "samplelights" samples emitters and skies only; it samples none
/// that illuminance loops handle.
bool LightSampling::samples(const Site& s, const BoundLight& light) const {
    if (!light.importance && (!s.lighting || rules_.emissionCounts)) return false; // only rays find it
    if (!s.lights || s.lighting) return s.lights;
    return (light.kind == LightKind::Area || light.isSky() || s.info->allLights) && light.strategy != LightStrategy::Illuminance;
}

/// Chooses a point on the light for a lit one. Returns false if the sample carries no light.
bool LightSampling::placeQuery(const BoundLight& light, const LightGuide* guide, const LightNumbers& u, const ShadePoint& lit,
                               ShadePoint& q, Emitter::Sample& s) const {
    takeLitPoint(q, lit);
    if (!placeLightSample(world_, light, guide, u, rules_.pickOne, q, s)) return false;
    // Sides 1: rays pass through the emitter from its back, so it sends nothing there.
    return v_.checksHits || light.kind != LightKind::Area || light.mean || !s.shape->oneSided() ||
           dot(intersectsNormal(q.surface), s.direction) < 0;
}

/// Chooses a point on the light for each point that samples it.
void LightSampling::sampleLight(const BoundLight& light, BatchContext& c) {
    const uint32_t use = kLightPoint + v_.numberOf(light);
    const bool pair = takesPair(light, rules_.pickOne);
    if (pair) drawOf(light, use << 1, v_.pairs);
    if (takesChoice(light)) drawOf(light, use << 1 | SampleNumbers::kSingle, v_.choices);
    const LightGuide* const guide = c.between || !rules_.pickOne ? nullptr : guideOf(world_, light);
    v_.asked.clear();
    surfaces_.pointsOfRows(c);
    for (size_t b = 0; b < v_.blocks; ++b)
        for (Lanes left = v_.lit[b]; left; left &= left - 1) {
            const int lane = std::countr_zero(left), point = int(b) * kBlock + lane;
            if (v_.asked.size() == v_.queries.size()) v_.queries.emplace_back(); // queries of the previous light are overwritten
            ShadePoint& q = v_.queries[v_.asked.size()];
            BlockQuery& a = v_.asked.emplace_back();
            a.point = point;
            LightNumbers u;
            if (pair) u.pair = {v_.pairs[b].x[lane], v_.pairs[b].y[lane]};
            if (takesChoice(light)) u.choose = v_.choices[b].x[lane];
            const ShadePoint& at = c.points[size_t(point)];
            const bool placed = placeQuery(light, guide, u, at, q, a.sample);
            if (!placed) v_.asked.pop_back();
            else if (v_.onlySite >= 0) // isWide()
                setEmitterFootprint(
                    q, c.rays[size_t(point)], at.P,
                    spreadBehind(c.rays[size_t(point)], v_.sites[size_t(v_.onlySite)].lobes[b].lobe[kRowSpread][lane]));
        }
    v_.queries.resize(v_.asked.size());
}

/// Makes room for the light's radiance; zero at first.
void LightSampling::beginLights(const BoundLight& light) {
    v_.lights.resize(v_.blocks);
    for (LightBlock& l : v_.lights) {
        l.asked = l.metDiffuse = l.metSpecular = 0;
        l.emitter = light.kind == LightKind::Area;
        l.met = light.hasDensity();
    }
}

/// Copies the light at the points into rows.
void LightSampling::takeValues(const BoundLight& light, const BatchContext& c) {
    beginLights(light);
    v_.queryAt.resize(v_.points);
    for (size_t k = 0; k < v_.asked.size(); ++k) {
        const LightValue& value = v_.values[k];
        const BlockQuery& a = v_.asked[k];
        if (value.lit && !isFinite(value.Cl)) accumulator_.notFinite(&c.rays[size_t(a.point)], "Cl", light.instance.get());
        else if (value.lit && value.Cl != Color(0)) {
            takeValue(v_.lights[size_t(a.point / kBlock)], a.point % kBlock, light, value, v_.queries[k], a.sample);
            v_.queryAt[size_t(a.point)] = int32_t(k);
        }
    }
}

/// Copies the radiance from one point on a light into a lane.
void LightSampling::takeValue(LightBlock& l, int lane, const BoundLight& light, const LightValue& value, const ShadePoint& query,
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

/// Applies the MIS weights of distance sampling to the light samples; removes samples of weight 0.
void LightSampling::takeParts(const BoundLight& light, const BatchContext& c) {
    v_.lights.resize(v_.blocks);
    std::erase_if(v_.litBlocks, [&](size_t b) {
        for (Lanes left = v_.lit[b]; left; left &= left - 1) {
            const size_t i = size_t(std::countr_zero(left));
            v_.lights[b].part[i] = mediumEvents_.shareOfDistance(c.flown[b * kBlock + i], light);
            if (v_.lights[b].part[i] == 0) v_.lit[b] &= ~(1u << i);
        }
        return v_.lit[b] == 0;
    });
}

bool LightSampling::needsPoints(const SurfaceBinding& b) const {
    const WorldImpl::LightList& list = world_.lightLists()[size_t(b.lightList)];
    const std::vector<int>& on = world_.sampledOf(list);
    return !rules_.pickOne || paths_.automaton || world_.lightsAsk() || choosesLights(list) ||
           !std::all_of(on.begin(), on.end(), [&](int l) { return inRows_[size_t(l)] != 0; });
}

} // namespace alpenglow::integrator

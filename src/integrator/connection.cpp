#include "integrator/connection.h"
#include "integrator/accumulator.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsample.h"
#include "integrator/lightsampling.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "services/random.h"
#include <algorithm>
#include <bit>
#include <numeric>

namespace alpenglow::integrator {

Connection::Connection(const StageSet& s, const VertexStages& v)
    : VertexStage(s, v), accumulator_(s.accumulator), lightSampling_(v.lights), media_(s.media), paths_(s.paths), store_(s.store),
      shadows_(s.shadows) {}

Connection::OwnShadows::OwnShadows(Connection& c, const Site& s) : connection_(c), own_(!s.options.empty() || s.sets) {
    if (!own_) return;
    shadow_ = c.v_.shadow;
    std::copy_n(c.v_.sent, kBlock, sent_);
    std::fill_n(c.v_.sent, kBlock, -1);
}

Connection::OwnShadows::~OwnShadows() {
    if (!own_) return;
    connection_.v_.shadow = shadow_;
    std::copy_n(sent_, kBlock, connection_.v_.sent);
}

void Connection::OwnShadows::limit(const Site& s, const size_t* points, const BoundLight* const* lights, const int32_t* queries,
                                   LightBlock& l) {
    if (!s.options.empty()) connection_.limitShadows(s, points, lights, l);
    if (connection_.v_.checksHits) connection_.dropUnhit(s, points, lights, queries, l);
}

void Connection::connect(const BoundLight& light, BatchContext& c) {
    for (size_t b = 0; b < v_.blocks; ++b)
        if (v_.lights[b].asked) connectBlock(b, light, c);
}

void Connection::weighAlone(const VertexBlock& points, const LobeBlock& lobe, const LightBlock& l, const float* kept, bool ahead,
                            Lanes met) {
    aloneLanes_ = world_.shadowVisibility().differs() && l.met ? met & l.asked : 0;
    if (!aloneLanes_) return;
    alone_ = v_.shadow;
    Lanes failed = 0;
    stages_.contribute(points, lobe, l, kept, 0, ahead, v_.value[0], alone_, &failed);
}

void Connection::noteAlone(const Site& s, size_t lane, int32_t more) {
    if (!(aloneLanes_ & 1u << lane)) return;
    const Color light{alone_.light[0][lane], alone_.light[1][lane], alone_.light[2][lane]};
    shadows_.alone.push_back(
        {size_t(v_.sent[lane]), more, light, visibilityBit(s.diffuse ? RayType::Diffuse : RayType::Specular)});
}

/// PathRay::path of light that comes from w.
uint16_t Connection::pathOf(const Site& s, size_t point, const Vec3& w, const BatchContext& c) const {
    const uint16_t path = v_.pathOf(s, false, point, w, c);
    return v_.mirrored ? paths_.next(path, paths_.mirror) : path;
}

/// Evaluates the lobes of a call site at `points` for their lights, into v_.value; adds the result to shadow rays that were
/// already sent. pointOf: by lane, index in the batch. Returns the lanes whose ray is still to be sent.
Lanes Connection::contribute(const Site& s, const VertexBlock& points, const LobeBlock& lobe, LightBlock& l, BatchContext& c,
                             const size_t* pointOf) {
    Lanes failed = 0, fresh = 0;
    for (size_t i = 0; v_.several && i < size_t(kBlock); ++i) draws_[i] = float(lightSampling_.drawsOf(s, pointOf[i]));
    l.draws = v_.several ? draws_ : nullptr; // the lobe's weight counts once for all of them
    s.addLightDirected(lobe.lights & l.asked, l.w, pointOf, v_.value[kRowPdf]);
    const float* kept = !s.lighting && l.met ? v_.whole : s.diffuse ? l.keptDiffuse : l.keptSpecular;
    const Lanes met = world_.settings().lightOnly ? 0 : s.diffuse ? l.metDiffuse : l.metSpecular;
    Lanes some = stages_.contribute(points, lobe, l, kept, met, !s.lighting, v_.value[0], v_.shadow, &failed);
    weighAlone(points, lobe, l, kept, !s.lighting, met);
    for (; failed; failed &= failed - 1) accumulator_.notFinite(c, c.rays[pointOf[std::countr_zero(failed)]], uint32_t(s.number));
    const bool sums = !s.lighting && s.info->trace->sums;
    if (sums && l.emitter) sumUnshadowed(s, points, lobe, l, some, c, pointOf);
    for (; some; some &= some - 1) {
        const int lane = std::countr_zero(some);
        if (v_.sent[lane] < 0) {
            fresh |= 1u << lane;
            continue;
        }
        ShadowRay& first = shadows_.queue[size_t(v_.sent[lane])];
        const Color light{v_.shadow.light[0][lane], v_.shadow.light[1][lane], v_.shadow.light[2][lane]};
        const uint16_t path = pathOf(s, pointOf[lane], {l.w[0][lane], l.w[1][lane], l.w[2][lane]}, c);
        shadows_.more.push_back(
            {light, c.targets[pointOf[lane]], v_.shareOf(s, pointOf[lane], c.rays[pointOf[lane]]), sums, path, first.more});
        first.more = int32_t(shadows_.more.size()) - 1;
        noteAlone(s, size_t(lane), first.more);
    }
    return fresh;
}

/// Makes the shadow rays of a block: one per point, for all of its lobes.
void Connection::connectBlock(size_t b, const BoundLight& of, BatchContext& c) {
    size_t points[kBlock];
    std::iota(points, points + kBlock, b * kBlock);
    const BoundLight* lights[kBlock];
    std::fill_n(lights, kBlock, &of);
    LightBlock& l = v_.lights[b];
    l.hasPart = c.between; // lightSampling_.takeParts()
    stages_.aim(v_.vertices[b], l, v_.shadow);
    std::fill_n(v_.sent, kBlock, -1);
    const Lanes placed = l.asked;
    for (size_t k = 0; k < v_.count; ++k) {
        const Site& s = v_.sites[k];
        const LobeBlock& lobe = s.lobes[b];
        l.asked = lightSampling_.litBy(k, b, of) & placed;
        OwnShadows own(*this, s);
        own.limit(s, points, lights, v_.checksHits ? v_.queryAt.data() + b * kBlock : nullptr, l);
        const Lanes asked = l.asked;
        if (asked) s.lanes->evaluate(lobe.lobe[0], asked, l.w[0], v_.value[0]);
        for (Lanes some = contribute(s, v_.vertices[b], lobe, l, c, points); some; some &= some - 1) {
            const size_t lane = size_t(std::countr_zero(some)), point = b * kBlock + lane;
            const int32_t query = v_.queryAt.empty() ? -1 : v_.queryAt[point];
            sendShadow(s, point, lane, {l.w[0][lane], l.w[1][lane], l.w[2][lane]}, of,
                       query < 0 ? nullptr : &v_.values[size_t(query)], c);
            if (of.hasDensity() && !c.between) {
                const VertexBlock& v = v_.vertices[b];
                const float light = luminance(Color(l.Cl[0][lane], l.Cl[1][lane], l.Cl[2][lane])), pdf = l.density[lane];
                shadows_.note({{{v.P[0][lane], v.P[1][lane], v.P[2][lane]},
                                {l.w[0][lane], l.w[1][lane], l.w[2][lane]},
                                light,
                                light / pdf,
                                pdf},
                               int(&of - world_.lights().data())});
            }
        }
    }
}

/// Sends the shadow ray of a lane of v_.shadow, from a point toward w; says: shadow parameters of the light, or null.
void Connection::sendShadow(const Site& site, size_t point, size_t lane, const Vec3& w, const BoundLight& of,
                            const LightValue* says, BatchContext& c) {
    const auto row3 = [&](const Row* r) { return Vec3(r[0][lane], r[1][lane], r[2][lane]); };
    v_.sent[lane] = int32_t(shadows_.queue.size());
    ShadowRay& s = shadows_.queue.emplace_back();
    s = {row3(v_.shadow.origin), row3(v_.shadow.direction), v_.shadow.length[lane],
         row3(v_.shadow.light),  c.targets[point],          world_.shadesAtOpen() ? 0 : c.rays[point].shutter(),
         &c.rays[point]};
    noteAlone(site, lane, -1);
    s.share = v_.shareOf(site, point, c.rays[point]);
    const bool emitter = of.kind == LightKind::Area;
    if (site.sets) s.kind = store_.kindOf({RayType::Transmission, false, site.raysAt(point).set, 0});
    s.areaLight = emitter && !site.lighting && site.info->trace->sums;
    if (!world_.media().empty()) s.media = media_.towards(c, int(point), w);
    s.path = pathOf(site, point, w, c);
    if (s.path) s.light = paths_.lights[v_.numberOf(of)];
    // Under the other hiders, light loops and trace() with "samplelights" let lights without "shadows" through.
    const bool asInLoops = !rules_.pickOne && (c.subsurface || (!site.lighting && !emitter && !of.isSky()));
    if (says && says->shadowRadius > 0) { // to a point on the disk
        const VertexBlock& v = v_.vertices[point / kBlock];
        const uint32_t use = kLightPoint + v_.numberOf(of), vertex = v.lightVertex[point % kBlock];
        const Vec2 u = store_.random(c.rays[point]).pair(vertex, use, 0);
        const Vec3 P(v.P[0][point % kBlock], v.P[1][point % kBlock], v.P[2][point % kBlock]);
        const Vec3 to = onShadowDisk(P - says->L, s.dir, says->shadowRadius, u) - s.origin;
        s.dir = normalizeOr(to, s.dir);
        s.distance = length(to) * (1 - 1e-5f);
    }
    // Not occluded; or the light's shader computed visibility itself.
    if (of.shadowless || (asInLoops && !of.shadows) || (says && says->ownShadow)) s.distance = 0;
}

/// Sets the shadow rays of a call with a bias or a limit of distance, and removes samples out of its reach.
/// points, lights: by lane.
void Connection::limitShadows(const Site& s, const size_t* points, const BoundLight* const* lights, LightBlock& l) {
    for (Lanes left = l.asked; left; left &= left - 1) {
        const size_t i = size_t(std::countr_zero(left)), point = points[i];
        const BoundLight& of = *lights[i];
        const RayOptions& o = s.options[point];
        const auto row3 = [&](const Row* r) { return Vec3(r[0][i], r[1][i], r[2][i]); };
        const Vec3 w = row3(l.w), origin = v_.originOf(s, point, w), way = row3(l.end) - origin;
        const Vec3 direction = l.emitter ? normalizeOr(way, w) : w;
        for (int q = 0; q < 3; ++q) v_.shadow.origin[q][i] = origin[q], v_.shadow.direction[q][i] = direction[q];
        v_.shadow.length[i] = l.emitter ? length(way) * (1 - 1e-6f) : of.isSky() ? o.maxDistance : l.far[i];
        const bool limited = l.emitter || (!of.isSky() && of.kind != LightKind::Distant);
        // Shadow rays end before a light without area by kShort, so the limit is shortened as well.
        constexpr float kShort = 1 - 1e-5f;
        const float away = l.emitter ? length(way) : l.far[i], most = l.emitter ? o.maxDistance : o.maxDistance * kShort;
        if (limited && away > most) l.asked &= ~(1u << i);
    }
}

/// Removes samples of an emitter from l.asked that rays of a call site would not hit. By lane: points in the batch, lights,
/// indices in v_.asked.
void Connection::dropUnhit(const Site& s, const size_t* points, const BoundLight* const* of, const int32_t* queryOf,
                           LightBlock& l) const {
    for (Lanes left = l.asked; left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const size_t query = size_t(queryOf[i]);
        const shading::RaySet& set = s.raysAt(points[i]).set;
        const geometry::Shape& shape = *v_.asked[query].sample.shape;
        const Vec3 w(l.w[0][i], l.w[1][i], l.w[2][i]);
        bool hit = s.lighting || !set.only || set.only[world_.numberOfShape().at(&shape)];
        // Sides 1: rays pass through the emitter from its back, so it sends nothing there.
        if (shape.oneSided() && set.sides != accel::Sides::Both && !(s.lighting && of[i]->mean))
            hit &= (dot(intersectsNormal(v_.queries[query].surface), w) >= 0) == (set.sides == accel::Sides::Back);
        if (!hit) l.asked &= ~(1u << i);
    }
}

/// Adds the light of samples of emitters to the sums of a waiting trace() that returns what it would be without occlusion.
/// v_.value: the lobes there. some: lanes that send it.
void Connection::sumUnshadowed(const Site& s, const VertexBlock& points, const LobeBlock& lobe, const LightBlock& l, Lanes some,
                               const BatchContext& c, const size_t* pointOf) {
    for (; some; some &= some - 1) {
        const size_t i = size_t(std::countr_zero(some)), point = pointOf[i];
        TraceSums* const of = accumulator_.sumsOf(c.targets[point]);
        if (!of) continue;
        const auto row3 = [&](const float(*r)[kBlock]) { return Color(r[0][i], r[1][i], r[2][i]); };
        const float fcos = v_.value[kRowFcos][i];
        Color light = row3(lobe.weight) * row3(points.weight) * row3(l.Cl);
        light *= row3(&v_.value[kRowColour]) / (fcos * float(lightSampling_.drawsOf(s, point)));
        of->add(TraceSums::UnshadowedAreaLight, light * (fcos / l.density[i]));
    }
}

} // namespace alpenglow::integrator

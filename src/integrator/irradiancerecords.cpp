// Irradiance caching (world/records.h): calls that interpolate records, and in the pass that makes records, the rays of new ones.
#include "integrator/irradiancerecords.h"
#include "bsdf/sampling.h"
#include "integrator/context.h"
#include "integrator/intersector.h"
#include "integrator/mediastacks.h"
#include "integrator/occlusioncalls.h"
#include "integrator/raystore.h"
#include "integrator/recordings.h"
#include "integrator/requests.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "world/raysets.h"
#include <bit>

namespace alpenglow::integrator {

IrradianceRecords::IrradianceRecords(const StageSet& s)
    : Stage(s.context), intersector_(s.intersector), media_(s.media), occlusion_(s.occlusion), store_(s.store),
      requests_(s.requests), shadows_(s.shadows) {}

namespace {

constexpr float kPixels = 20; ///< default of "maxpixeldist"

uint64_t mixed(uint64_t h, float v) { return mix64(h ^ std::bit_cast<uint32_t>(v)); }

/// Whether the cone is the whole hemisphere: records hold no other kind.
bool wholeHemisphere(float cone) { return std::fabs(cone - float(kPi / 2)) < 1e-4f; }

} // namespace

std::optional<Color> IrradianceRecords::recorded(const BatchContext& c, const SiteInfo& s, int point,
                                                 const std::function<float(int)>& f, const RayKind* kind, uint32_t occurrence) {
    const ShadePoint& p = c.points[size_t(point)];
    const RaySite& r = *s.rays;
    const RecordSite& site = s.occlusion ? s.occlusion->records : s.trace->records;
    const FadeSite& fade = s.occlusion ? s.occlusion->fade : s.trace->fade;
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const auto triple = [&](int row) { return Vec3(f(row), f(row + 1), f(row + 2)); };
    const float variation = number(site.variation, 0);
    if (!(variation > 0) || c.light || !p.ray || !p.ray->sample || p.ray->quiet) return {};
    if (!wholeHemisphere(number(s.occlusion ? s.occlusion->cone : s.rowCone, float(kPi / 2)))) return {};
    const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[size_t(point)])];
    Recording n;
    LightRecord& record = n.record;
    record.P = triple(s.rows[0]);
    record.N = triple(s.rows[1]);
    const float l = length(record.N);
    if (!(l > 0) || !std::isfinite(l)) return {};
    record.N = record.N / l;
    const float far = std::min(number(r.maxDistance, 1e38f), number(r.maxHit, 1e38f)), reach = far >= 0 ? far : 1e38f;
    n.fade = {std::max(0.f, number(fade.strength, 0)), reach, number(fade.mode, 0) != 0};
    record.call = mixed(mixed(mix64(site.call + uint64_t(b.group)), reach), n.fade.strength);
    record.call = mixed(record.call, float(n.fade.polynomial));
    // The same rays, the same surfaces, and behind them the same sky.
    // Owned by the world, equal for all threads
    record.call = mix64(record.call ^ reinterpret_cast<uintptr_t>(kind->set.only));
    record.call = mixed(mixed(record.call, float(kind->set.sides)), float(kind->set.mode));
    record.call = mixed(record.call, float(kind->type));
    if (!s.occlusion && s.trace->map) {
        n.tint = s.trace->tint < 0 ? Color(1) : triple(s.trace->tint);
        for (int k = 0; k < 3; ++k) record.call = mixed(record.call, n.tint[k]);
    }
    // Where the depth limit leaves an exact call without light, records give none either.
    const PathRay& from = *p.ray;
    const bool diffuse = kind->type == RayType::Diffuse;
    const int most = diffuse ? b.maxDiffuse : b.maxSpecular;
    if (!s.occlusion && (from.bounces + 1 > world_.maxDepth() || (diffuse && !world_.settings().indirect) ||
                         (most >= 0 && (diffuse ? from.diffuseBounces : from.specularBounces) + 1 > most)))
        return {};
    Color light;
    if (world_.records().find(record.call, record.P, record.N, light)) {
        ++counters_.interpolated;
        return light;
    }
    if (!from.sample->records || from.bounces > 0) return {};
    record.change = std::sqrt(std::min(variation, 1.f));
    n.most = std::clamp(number(site.pixels, kPixels), 1.f, 1e6f);
    const float way = length(p.P - from.origin);
    n.pixel = 2 * from.footprint.at(way);
    if (!(n.pixel > 0)) n.pixel = 1e-3f * way;
    const uint32_t call = uint32_t(s.site - c.bound->kernel->sites().data());
    record.place = {from.sample->py, from.sample->px, from.vertex, call, occurrence};
    const int count = occlusion_.samplesOf(number(r.samples, 0), p.shape, s, c);
    n.rings = std::max(1, int(std::sqrt(float(count) / float(kPi)) + .5f));
    n.turns = std::max(1, (count + n.rings / 2) / n.rings);
    n.reach = reach;
    n.bias = number(r.bias, -1);
    if (n.bias < 0 && s.occlusion) n.bias = occlusion_.ofShape(p.shape).bias;
    if (n.bias < 0 && b.bias > 0) n.bias = b.bias;
    n.kind = kind;
    n.site = s.trace.get();
    n.blocks = s.occlusion != nullptr;
    sendRecord(c, point, call, occurrence, n);
    ++counters_.records;
    return Color(0); // the picture of this pass is discarded
}

/// Sends one ray for each cell: rings of equal weight around the normal, each divided in azimuth.
void IrradianceRecords::sendRecord(const BatchContext& c, int point, uint32_t call, uint32_t occurrence, Recording& n) {
    const ShadePoint& p = c.points[size_t(point)];
    const PathRay& from = *p.ray;
    const Vec3 at = n.record.P;
    const Basis about(n.record.N);
    n.axes = {about.t, about.u, n.record.N};
    const bool here = length(at - p.P) <= geometry::roundingError(at) + 4 * p.surface.pError;
    for (int i = 0; i < n.rings * n.turns; ++i) {
        const Vec2 e = store_.random(from).pair(from.vertex, call, occurrence * 4096 + uint32_t(i));
        const float r2 = (float(i / n.turns) + e.x) / float(n.rings), r = std::sqrt(r2);
        const Vec2 d = unitCircle((float(i % n.turns) + e.y) / float(n.turns));
        const Vec3 w = about.t * (r * d.x) + about.u * (r * d.y) + n.record.N * std::sqrt(std::max(0.f, 1 - r2));
        PathRay ray = from;
        ray.weight = Color(1);
        ray.vertex = childVertex(from.vertex, call, occurrence * 4096 + uint32_t(i));
        ++ray.bounces;
        ++(n.kind->type == RayType::Diffuse ? ray.diffuseBounces : ray.specularBounces);
        ray.origin = n.bias >= 0 ? at + w * n.bias
                     : here      ? geometry::offsetOrigin(p.surface, w, length(p.P - p.surface.P) + length(at - p.P))
                                 : at + w * geometry::roundingError(at);
        ray.dir = w;
        ray.maxDistance = n.reach;
        ray.kind = n.kind;
        ray.media = media_.towards(c, point, w);
        ray.crossedMedium = ray.passed = false;
        ray.extra = -1;
        ray.lobePdf = -1; // no light is sampled for it: emission counts in full
        ray.lobeBinding = -1;
        ray.footprint = from.footprint.after(length(p.P - from.origin));
        ray.footprint.spread = std::max(ray.footprint.spread, .5f / std::sqrt(float(n.rings * n.turns)));
        ray.counts = false;
        ray.first = true;
        n.rays.push_back(ray);
    }
    recordings_.push_back(std::move(n));
}

/// occlusion() uses shadow rays, whose ends give the distances; results of other rays are known after tracing.
void IrradianceRecords::follow(Sched& sched) {
    for (; recordsSent_ < recordings_.size(); ++recordsSent_) {
        Recording& n = recordings_[recordsSent_];
        if (n.blocks) {
            blockedRecord(n);
            continue;
        }
        for (PathRay& r : n.rays) {
            RayExtra extra;
            if (n.site->map) extra.environment = n.tint * requests_.mapTowards(*n.site, r.dir, r.footprint.spread);
            extra.fade = n.fade;
            r.extra = store_.newExtra(extra);
            n.targets.push_back(sched.newRoot());
            sched.spawn(r.bounces + r.layers, n.targets.back(), r);
        }
        n.rays.clear();
        n.rays.shrink_to_fit();
    }
}

void IrradianceRecords::blockedRecord(Recording& n) {
    std::vector<ShadowRay> rays;
    for (const PathRay& r : n.rays) {
        ShadowRay& s = rays.emplace_back();
        s = {r.origin, r.dir, n.reach, Color(1), shading::kNoAccumulator, r.shutter(), nullptr};
        s.kind = n.kind;
        s.media = r.media;
        s.hemisphere = int32_t(occlusion_.hemispheres.size());
        accel::Hit hit;
        n.ways.push_back(intersector_.intersect(rayOf(s), hit) ? float(hit.distance) : 1e38f);
    }
    HemisphereRays h;
    h.site = n.site;
    h.fade = n.fade;
    occlusion_.hemispheres.push_back(h);
    n.seen.resize(rays.size());
    shadows_.transmittances(rays, n.seen);
    for (Color& s : n.seen) s = Color(mean(s));
    occlusion_.hemispheres.pop_back();
    n.rays.clear();
}

void IrradianceRecords::keep(const Sched& sched) {
    for (Recording& n : recordings_) {
        for (const AccumulatorId t : n.targets) {
            const shading::TargetValue v = sched.value(t);
            n.seen.push_back(v.radiance);
            n.ways.push_back(v.distance);
        }
        if (n.seen.empty() || !std::all_of(n.seen.begin(), n.seen.end(), isFinite)) continue;
        n.record.take(n.axes, n.rings, n.turns, n.seen, n.ways, n.pixel, n.most);
        if (isFinite(n.record.light)) world_.records().add(n.record);
    }
    forget();
}

void IrradianceRecords::forget() {
    recordings_.clear();
    recordsSent_ = 0;
    shadows_.settled.clear();
}

} // namespace alpenglow::integrator

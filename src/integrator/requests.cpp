// Interprets the requests of kernels at points (docs/design/rsl.md). singlerequests.h takes the lobes.
#include "integrator/requests.h"
#include "base/direction.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/ambientlight.h"
#include "integrator/context.h"
#include "integrator/irradiancerecords.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/occlusioncalls.h"
#include "integrator/photonstage.h"
#include "integrator/rayoptions.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/subsurfacewalks.h"
#include "shadeops/distributions.h"
#include "texture/lookup.h"
#include "world/blocksite.h"
#include "world/raysets.h"
#include <bit>

namespace alpenglow::integrator {

Requests::Requests(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), ambient_(s.ambient), records_(s.records), paths_(s.paths),
      litSurfaces_(s.litSurfaces), media_(s.media), occlusion_(s.occlusion), photons_(s.photons), store_(s.store),
      shadows_(s.shadows), subsurface_(s.subsurface) {}

namespace {
/// Parameters of the distributions of bsdf(), given or default (3Delight manual, 6.4.5.2).
template <class Row> DistributionParams distributionOf(const SiteInfo& s, const LobeKind& kind, const Row& f) {
    const TraceSite& t = *s.trace;
    DistributionParams m;
    auto triple = [&](int row) { return Color(f(row), f(row + 1), f(row + 2)); };
    if (t.roughness >= 0) m.roughness = f(t.roughness);
    m.roughnessv = t.roughnessv >= 0 ? f(t.roughnessv) : m.roughness;
    if (t.udir >= 0) m.udir = triple(t.udir);
    if (t.absorption >= 0) m.absorption = triple(t.absorption);
    m.eta = Color(kind.eta);
    for (size_t k = 0; k < t.eta.size() && k < 2; ++k)
        (k ? m.k : m.eta) = t.eta[k].second == 1 ? Color(f(t.eta[k].first)) : triple(t.eta[k].first);
    for (int row : t.lobes) m.lobes.push_back(f(row));
    m.part = t.part;
    return m;
}

/// Whether a trace() has no direction, as from refract() at total reflection: it sends no ray and returns no light.
template <class Row> bool pointsNowhere(const SiteInfo& s, const Row& f) {
    if (s.kind != SiteKind::Trace || s.trace->hemisphere) return false;
    const int row = s.rows[1];
    return f(row) == 0 && f(row + 1) == 0 && f(row + 2) == 0;
}
} // namespace

/// Requests that shadow rays answer.
void Requests::requestShadows(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& f,
                              const Color& weight, AccumulatorId target, bool owns, uint32_t occurrence) {
    const ShadePoint& p = c.points[size_t(point)];
    const uint32_t site = uint32_t(s.site - c.bound->kernel->sites().data());
    const size_t had = shadows_.queue.size(), settled = shadows_.settled.size();
    if (s.kind == SiteKind::Ambient) {
        ambient_.asked.push_back({point, Vec3(f(s.rows[0]), f(s.rows[0] + 1), f(s.rows[0] + 2)), weight, target, owns});
        if (!world_.lightsAsk()) return;
        ambient_.asked.back().lit = int(litSurfaces_.values.size());
        litSurfaces_.values.push_back(litValuesOf(c, s, point, f));
        return;
    }
    if (s.kind == SiteKind::Transmission) {
        if (s.rays->samples >= 0 && s.rays->cone >= 0 && f(s.rays->cone) > 0)
            occlusion_.samplesOf(std::max(1.f, f(s.rays->samples)), p.shape, s, c); // reports too many samples
        shadows_.transmissionRays(s, p, p.P, &p.surface, f, weight, target, site, occurrence, shadows_.queue);
        const auto v = [&](int arg) {
            return Vec3(f(s.rows[size_t(arg)]), f(s.rows[size_t(arg)] + 1), f(s.rows[size_t(arg)] + 2));
        };
        media_.shadowsInMedia(std::span(shadows_.queue).subspan(had), v(0), v(1), p.P, &p.surface,
                              c.bindings.empty() ? nullptr : &world_.bindings()[size_t(c.bindings[size_t(point)])]);
    } else {
        if (s.occlusion->records.call) {
            RayKind kind = kShadowKind;
            kind.set = store_.raySetOf(s, f, p.shape, kind.type, kind.label);
            if (const auto open = records_.recorded(c, s, point, f, store_.kindOf(kind), occurrence)) {
                shadows_.settled.push_back(
                    {target, weight * *open, LightEvent::Sampled, p.ray, owns || !p.ray ? -1 : store_.extraOf(*p.ray).share});
                return;
            }
        }
        occlusion_.hemisphereRays(c, s, p, p.P, &p.surface, f, weight, target, site, occurrence, shadows_.queue);
        for (size_t k = had; k < shadows_.queue.size(); ++k)
            shadows_.queue[k].media = media_.towards(c, point, shadows_.queue[k].dir);
    }
    if (owns || !p.ray) return;
    for (size_t k = had; k < shadows_.queue.size(); ++k) { // the weight is the shader's own
        shadows_.queue[k].share = store_.extraOf(*p.ray).share;
        shadows_.queue[k].path = p.ray->path;
        shadows_.queue[k].light = paths_.object;
    }
    for (size_t k = settled; k < shadows_.settled.size(); ++k) {
        shadows_.settled[k].share = store_.extraOf(*p.ray).share;
        shadows_.settled[k].end = paths_.next(p.ray->path, paths_.object);
    }
}

/// Which surfaces the rays of a trace() hit.
template <class Row> const RayKind* Requests::raysOfTrace(const SiteInfo& s, const Row& f, const ShadePoint& p) {
    const bool lights = s.rowLights >= 0 && f(s.rowLights) != 0, indirectOnly = s.trace->apart;
    if (s.rays->fixed && !(world_.traceSubsets() && s.rays->subsetText.empty())) // the most frequent case, many times a sample
        return store_.kindOf(
            {s.rays->rays, true, s.rays->set, s.label, s.trace->hemisphere && world_.globalMaps(), lights, indirectOnly});
    RayKind kind{RayType::Diffuse, true, {}, 0, s.trace->hemisphere && world_.globalMaps(), lights, indirectOnly};
    kind.set = store_.raySetOf(s, f, p.shape, kind.type, kind.label);
    return store_.kindOf(kind);
}

/// The lobe that a call requests; null: none, or an unknown distribution.
template <class Row> const LobeKind* Requests::lobeOf(const BatchContext& c, const SiteInfo& s, const Row& f) {
    if (!s.trace || s.trace->distribution < 0) return s.lobe;
    const auto id = std::bit_cast<int32_t>(f(s.trace->distribution));
    const auto [known, fresh] = lobesNamed_.try_emplace({s.site, id}, s.lobe);
    if (!fresh) return known->second;
    const std::string& name = rsl::internedString(id);
    if (name.empty()) return s.lobe;
    if (shadeops::isDistribution(name, true)) return known->second = findLobe(name);
    const auto& files = c.bound->kernel->files();
    const auto& at = s.site->place;
    const SourcePlace place{size_t(at.file) < files.size() ? files[size_t(at.file)] : "", at.line, at.column};
    diagnostics_.reportOnce("distribution:" + name + place.file + std::to_string(place.line),
                            {Severity::Error,
                             Rie::BadToken,
                             place,
                             shadeops::noDistribution(s.site->op, name) + "; the call returns no light",
                             shadeops::knownDistributions(),
                             {}});
    return known->second = nullptr;
}

/// Reads lobe and rays of a trace(); returns false if its weight is 0, so that no ray is sent.
template <class Row>
bool Requests::askOfTrace(const BatchContext& c, const SiteInfo& s, const ShadePoint& p, const Row& f, LobeVertex& l,
                          LobeParams& params) {
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const auto vector = [&](int row, const Vec3& fallback) { return row < 0 ? fallback : Vec3(f(row), f(row + 1), f(row + 2)); };
    params.axis = directionOr(vector(s.rows[1], Vec3()), p.surface.n);
    params.wo = directionOr(vector(s.rowWo, params.wo), params.wo);
    params.a = l.kind->has(kTakesExponent) ? number(s.rowExponent, 1000) : number(s.rowCone, 0);
    l.trace = s.trace.get();
    if ((params.hasHorizon = s.rowHorizon >= 0)) params.horizon = directionOr(vector(s.rowHorizon, p.surface.n), p.surface.n);
    l.rays = raysOfTrace(s, f, p);
    l.lights = l.rays->asksLights;
    const RayOptions options = rayOptionsOf(s, f);
    l.bias = options.bias, l.base = number(s.rays->base, 0);
    l.importance = options.importance;
    l.maxDistance = options.maxDistance;
    l.fade = options.fade;
    if (s.trace->map) l.tint = vector(s.trace->tint, Color(1));
    // From a point off the surface no light is sampled: emission counts in full.
    if (const Vec3 from = vector(s.rows[0], Vec3()), away = from - p.P;
        !p.surface.displaced && length(away) > geometry::roundingError(p.P) + 4 * p.surface.pError) {
        l.ownOrigin = true;
        l.from = from;
    }
    l.lobeOfShader = false;
    l.samples = occlusion_.samplesOf(samplesAskedOf(s, f), p.shape, s, c);
    return l.importance > 0 || photons_.photonTrace();
}

void Requests::request(BatchContext& c, const SiteInfo& s, int point, const float* in, int lanes, int lane, Color weight,
                       AccumulatorId target, bool owns, uint32_t occurrence) {
    const ShadePoint& p = c.points[point];
    const auto f = [&](int row) { return in[size_t(row) * lanes + lane]; };
    auto v = [&](int arg) { return Vec3(f(s.rows[arg]), f(s.rows[arg] + 1), f(s.rows[arg] + 2)); };
    if (asksShadows(s.kind)) return requestShadows(c, s, point, f, weight, target, owns, occurrence);
    const LobeKind* const kind = lobeOf(c, s, f);
    if (!kind || pointsNowhere(s, f)) return;
    if (s.kind == SiteKind::Trace && s.trace->apart && !owns) apartAt.push_back(point);
    if (s.kind == SiteKind::Trace && s.trace->records.call) {
        if (const auto light = records_.recorded(c, s, point, f, raysOfTrace(s, f, p), occurrence)) {
            shadows_.settled.push_back({target, weight * *light * (owns ? Color(1) : p.ray->weight), LightEvent::Sampled, p.ray,
                                        owns ? -1 : store_.extraOf(*p.ray).share});
            if (!owns) shadows_.settled.back().end = paths_.next(p.ray->path, paths_.object);
            return;
        }
    }
    LobeVertex& l = lobes.emplace_back();
    l.kind = kind;
    LobeParams params;
    l.point = point;
    l.weight = weight;
    l.target = target;
    l.ownsTarget = owns;
    l.site = uint32_t(s.site - c.bound->kernel->sites().data());
    l.occurrence = occurrence;
    if (world_.lightsAsk()) {
        l.lit = int(litSurfaces_.values.size());
        litSurfaces_.values.push_back(litValuesOf(c, s, point, f));
    }
    if (s.kind == SiteKind::Subsurface) {
        subsurface_.request(c, s, p, f, l);
        l.place = rows.add(*l.kind, {p.surface.n, params.wo, {}, 0});
        return;
    }
    if (s.kind != SiteKind::Diffuse) params.wo = normalizeOr(-p.I, p.surface.n);
    switch (s.kind) {
    case SiteKind::Diffuse:
        params.axis = directionOr(v(0), p.surface.n);
        l.rays = &kDiffuseKind;
        if (s.trace && s.trace->apart) l.indirect = 0; // indirectdiffuse() adds the light of surfaces
        break;
    case SiteKind::Specular:
    case SiteKind::Phong:
        params.axis = directionOr(v(0), p.surface.n);
        params.wo = directionOr(v(1), params.wo);
        params.a = f(s.rows[2]);
        if (s.kind == SiteKind::Specular) params.a = s.exponent / std::max(params.a, 1e-6f);
        l.rays = &kSpecularKind;
        break;
    case SiteKind::Trace:
        if (!askOfTrace(c, s, p, f, l, params)) {
            counters_.ignored += uint64_t(l.samples);
            lobes.pop_back();
            return;
        }
        if (s.trace->hemisphere) occlusion_.noteTurnedAway(c, s, point, params.axis);
        break;
    default:
        break;
    }
    const DistributionParams more = l.kind->distribution ? distributionOf(s, *kind, f) : DistributionParams();
    l.place = rows.add(*l.kind, params, l.kind->distribution ? &more : nullptr);
}

Color Requests::mapTowards(const TraceSite& t, const Vec3& w, float spread) const {
    const Vec3 at(transformVector(t.toMap, Vec3d(w)));
    const Basis b(directionOr(at, Vec3(0, 0, 1)));
    float v[3] = {};
    texture::LookupOptions colours;
    colours.asLight = true;
    texture::environment(t.map, world_.textures().latLong(), 0, 3, at, b.t * spread, b.u * spread, colours, v);
    return {v[0], v[1], v[2]};
}

void Requests::requestPairs(BatchContext& c, std::vector<AskedLobe>* asked, Sched& sched, bool lobesToo) {
    const int n = int(c.points.size());
    std::vector<uint32_t>& occurrence = occurrence_;
    occurrence.assign(c.emits.empty() ? 0 : c.bound->sites.size() * size_t(n), 0);
    for (const EmitRecord& e : c.emits) {
        const SiteInfo& s = c.bound->sites[e.site];
        if (s.kind == SiteKind::Ambient ? !ambient_.lights
                                        : !lobesToo && !asksShadows(s.kind) && s.kind != SiteKind::LightVisibility)
            continue;
        const float* pair = c.arena.data() + e.offset;
        for (int lane = 0; lane < e.lanes; ++lane) {
            int point = e.first + lane;
            if (!(e.mask >> lane & 1) || point >= n) continue;
            Color weight = Color(pair[lane], pair[e.lanes + lane], pair[2 * e.lanes + lane]);
            if (!isFinite(weight)) {
                accumulator_.notFinite(c, c.rays[size_t(point)], uint32_t(e.site));
                continue;
            }
            if (weight == Color(0) || c.rays[size_t(point)].quiet) continue;
            if (world_.bindings()[c.bindings[point]].matte && c.rays[point].camera()) continue;
            const float* args = pair + size_t(3) * e.lanes;
            if (photons_.photonTrace() && (s.kind == SiteKind::LightVisibility || asksShadows(s.kind)))
                continue; // light seen by photons is discarded
            if (s.kind == SiteKind::LightVisibility) {
                const size_t had = shadows_.queue.size();
                lightVisibility(c, s, point, args, e.lanes, lane, weight * c.rays[point].weight, c.targets[point]);
                if (shadows_.queue.size() > had) {
                    const PathRay& ray = c.rays[size_t(point)];
                    shadows_.queue.back().share = store_.extraOf(ray).share;
                    shadows_.queue.back().path =
                        paths_.atLoop(c.points[size_t(point)], ray, shadows_.queue.back().dir, paths_.loopLabel);
                    shadows_.queue.back().light =
                        e.light >= 0 && !paths_.lights.empty() ? paths_.lights[size_t(e.light)] : paths_.loopLight;
                }
                continue;
            }
            if (asksShadows(s.kind)) weight *= c.rays[point].weight;
            const size_t had = lobes.size();
            if (shadows_.queue.size() > kShadowsAtOnce) shadows_.flush(sched);
            request(c, s, point, args, e.lanes, lane, weight, c.targets[point], false,
                    occurrence[size_t(e.site) * size_t(n) + size_t(point)]++);
            if (asked && lobes.size() > had) asked->push_back({int(had), int(&e - c.emits.data()), lane});
        }
    }
}

void Requests::clear() {
    lobes.clear();
    rows.clear();
}

} // namespace alpenglow::integrator

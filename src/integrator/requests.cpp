// Requests of kernels: what a call asks for at a point (design decisions 2 and 3). What becomes of lobes is in gather.h.
#include "base/direction.h"
#include "integrator/gather.h"
#include "lobes/sampling.h"
#include "shadeops/distributions.h"
#include "texture/lookup.h"
#include "world/blocksite.h"
#include "world/raysets.h"
#include <bit>

namespace alpenglow::transport {

namespace {
/// Parameters of the distributions of bsdf(), as given or as they are when not (rsl.md 12.4).
template <class Row> DistributionParams distributionOf(const SiteInfo& s, const LobeKind& kind, const Row& f) {
    const TraceSite& t = *s.trace;
    DistributionParams m;
    auto triple = [&](int row) { return Color(f(row), f(row + 1), f(row + 2)); };
    if (t.roughness >= 0) m.roughness = f(t.roughness);
    m.roughnessv = t.roughnessv >= 0 ? f(t.roughnessv) : m.roughness;
    if (t.udir >= 0) m.udir = triple(t.udir);
    if (t.absorption >= 0) m.absorption = triple(t.absorption);
    m.eta = Color(defaultEta(kind));
    for (size_t k = 0; k < t.eta.size() && k < 2; ++k)
        (k ? m.k : m.eta) = t.eta[k].second == 1 ? Color(f(t.eta[k].first)) : triple(t.eta[k].first);
    for (int row : t.lobes) m.lobes.push_back(f(row));
    m.part = t.part;
    return m;
}

/// Whether a trace() has no direction, as that of refract() at total reflection: no ray goes there, nothing comes from there.
template <class Row> bool pointsNowhere(const SiteInfo& s, const Row& f) {
    if (s.kind != SiteKind::Trace || s.trace->hemisphere) return false;
    const int row = s.rows[1];
    return f(row) == 0 && f(row + 1) == 0 && f(row + 2) == 0;
}

/// What lights may ask about a point that asks for light.
template <class Row> LitValues litValues(const BatchContext& c, const SiteInfo& s, int point, const Row& f) {
    LitValues told;
    told.binding = size_t(point) < c.bindings.size() ? c.bindings[size_t(point)] : -1; // a light's own ray: none
    told.displaced = c.displaced;
    told.point = point;
    for (const SiteInfo::Output& o : s.outputs) {
        auto& of = told.outputs.emplace_back(&o, std::vector<float>());
        for (int r = 0; r < o.size; ++r) of.second.push_back(f(o.row + r));
    }
    return told;
}
} // namespace

/// Questions that shadow rays answer.
void Engine::requestShadows(BatchContext& c, const SiteInfo& s, int point, const std::function<float(int)>& f,
                            const Color& weight, TargetId target, bool owns, uint32_t occurrence) {
    const ShadePoint& p = c.points[size_t(point)];
    const uint32_t site = uint32_t(s.site - c.bound->kernel->sites().data());
    const size_t had = shadows.size(), settled = settled_.size();
    if (s.kind == SiteKind::Ambient) {
        ambients_.push_back({point, Vec3(f(s.rows[0]), f(s.rows[0] + 1), f(s.rows[0] + 2)), weight, target, owns});
        if (!world_->lightsAsk()) return;
        ambients_.back().lit = int(litValues_.size());
        litValues_.push_back(litValues(c, s, point, f));
        return;
    }
    if (s.kind == SiteKind::Transmission) {
        if (s.rays->samples >= 0 && s.rays->cone >= 0 && f(s.rays->cone) > 0)
            samplesOf(std::max(1.f, f(s.rays->samples)), p.shape, s, c); // says when there are too many
        transmissionRays(s, p, p.P, &p.surface, f, weight, target, site, occurrence, shadows);
        const auto v = [&](int arg) {
            return Vec3(f(s.rows[size_t(arg)]), f(s.rows[size_t(arg)] + 1), f(s.rows[size_t(arg)] + 2));
        };
        shadowsInMedia(std::span(shadows).subspan(had), v(0), v(1), p.P, &p.surface,
                       c.bindings.empty() ? nullptr : &world_->bindings_[size_t(c.bindings[size_t(point)])]);
    } else {
        if (s.occlusion->records.call) {
            RayKind kind = kShadowKind;
            kind.set = raySetOf(s, f, p.shape, kind.type, kind.label);
            if (const auto open = recorded(c, s, point, f, kindOf(kind), occurrence)) {
                settled_.push_back(
                    {target, weight * *open, LightEvent::Sampled, p.ray, owns || !p.ray ? -1 : extraOf(*p.ray).share});
                return;
            }
        }
        hemisphereRays(c, s, p, p.P, &p.surface, f, weight, target, site, occurrence, shadows);
        for (size_t k = had; k < shadows.size(); ++k) shadows[k].media = mediaTowards(c, point, shadows[k].dir);
    }
    if (owns || !p.ray) return;
    for (size_t k = had; k < shadows.size(); ++k) { // what it weighs is the shader's own
        shadows[k].share = extraOf(*p.ray).share;
        shadows[k].path = p.ray->path;
        shadows[k].light = object_;
    }
    for (size_t k = settled; k < settled_.size(); ++k) {
        settled_[k].share = extraOf(*p.ray).share;
        settled_[k].end = pathEvent(p.ray->path, object_);
    }
}

/// Which surfaces rays of a trace() meet.
template <class Row> const RayKind* Engine::raysOfTrace(const SiteInfo& s, const Row& f, const ShadePoint& p) {
    const bool lights = s.rowLights >= 0 && f(s.rowLights) != 0, indirectOnly = s.trace->apart;
    if (s.rays->fixed && !(world_->traceSubsets_ && s.rays->subsetText.empty())) // what most calls are, many times a sample
        return kindOf(
            {s.rays->rays, true, s.rays->set, s.label, s.trace->hemisphere && world_->globalMaps_, lights, indirectOnly});
    RayKind kind{RayType::Diffuse, true, {}, 0, s.trace->hemisphere && world_->globalMaps_, lights, indirectOnly};
    kind.set = raySetOf(s, f, p.shape, kind.type, kind.label);
    return kindOf(kind);
}

/// The lobe that a call asks for; null: none, or a distribution that there is not.
template <class Row> const LobeKind* Engine::lobeOf(const BatchContext& c, const SiteInfo& s, const Row& f) {
    if (!s.trace || s.trace->distribution < 0) return s.lobe;
    const auto id = std::bit_cast<int32_t>(f(s.trace->distribution));
    const auto [known, fresh] = lobesNamed_.try_emplace({s.site, id}, s.lobe);
    if (!fresh) return known->second;
    const std::string& name = rsl::internedString(id);
    if (name.empty()) return s.lobe;
    if (rsl::isDistribution(name, true)) return known->second = findLobe(name);
    const auto& files = c.bound->kernel->files();
    const auto& at = s.site->place;
    const SourcePlace place{size_t(at.file) < files.size() ? files[size_t(at.file)] : "", at.line, at.column};
    diagnostics_.reportOnce("distribution:" + name + place.file + std::to_string(place.line),
                            {Severity::Error,
                             Rie::BadToken,
                             place,
                             rsl::noDistribution(s.site->op, name) + "; the call brings no light",
                             rsl::knownDistributions(),
                             {}});
    return known->second = nullptr;
}

/// What a trace() says of its lobe and its rays; false: its weight is 0, and nothing is sent.
template <class Row>
bool Engine::askOfTrace(const BatchContext& c, const SiteInfo& s, const ShadePoint& p, const Row& f, LobeVertex& l,
                        LobeParams& params) {
    const auto number = [&](int row, float fallback) { return row < 0 ? fallback : f(row); };
    const auto vector = [&](int row, const Vec3& fallback) { return row < 0 ? fallback : Vec3(f(row), f(row + 1), f(row + 2)); };
    params.axis = directionOr(vector(s.rows[1], Vec3()), p.surface.n);
    params.wo = directionOr(vector(s.rowWo, params.wo), params.wo);
    params.a = l.kind->name == "slphong" ? number(s.rowExponent, 1000) : number(s.rowCone, 0);
    l.trace = s.trace.get();
    if ((params.hasHorizon = s.rowHorizon >= 0)) params.horizon = directionOr(vector(s.rowHorizon, p.surface.n), p.surface.n);
    l.rays = raysOfTrace(s, f, p);
    l.lights = l.rays->asksLights;
    l.bias = number(s.rays->bias, -1), l.base = number(s.rays->base, 0);
    if (s.trace->weight >= 0) l.importance = std::max(0.f, maxComponent(vector(s.trace->weight, Color(1))));
    if (s.trace->map) l.tint = vector(s.trace->tint, Color(1));
    // From a point that is not the surface's no light is sampled: rays that meet an emitter count in full.
    if (const Vec3 from = vector(s.rows[0], Vec3()), away = from - p.P;
        !p.surface.displaced && length(away) > geometry::roundingError(p.P) + 4 * p.surface.pError) {
        l.elsewhere = true;
        l.from = from;
    }
    l.deltaLights = l.lobeOfShader = false;
    l.maxDistance = std::min(number(s.rays->maxDistance, 1e38f), number(s.rays->maxHit, 1e38f));
    if (l.maxDistance < 0) l.maxDistance = 1e38f; // PRMan: none
    if (const FadeSite& fade = s.trace->fade; fade.strength >= 0)
        l.fade = {std::max(0.f, f(fade.strength)), l.maxDistance, number(fade.mode, 0) != 0};
    const float samples = s.trace->hemisphere ? number(s.rays->samples, 0) : std::max(1.f, number(s.rays->samples, 1));
    l.samples = samplesOf(samples, p.shape, s, c);
    return l.importance > 0 || photonTrace_;
}

void Engine::request(BatchContext& c, const SiteInfo& s, int point, const float* in, int lanes, int lane, Color weight,
                     TargetId target, bool owns, uint32_t occurrence) {
    const ShadePoint& p = c.points[point];
    const auto f = [&](int row) { return in[size_t(row) * lanes + lane]; };
    auto v = [&](int arg) { return Vec3(f(s.rows[arg]), f(s.rows[arg] + 1), f(s.rows[arg] + 2)); };
    if (asksShadows(s.kind)) return requestShadows(c, s, point, f, weight, target, owns, occurrence);
    const LobeKind* const kind = lobeOf(c, s, f);
    if (!kind || pointsNowhere(s, f)) return;
    if (s.kind == SiteKind::Trace && s.trace->apart && !owns) apartAt_.push_back(point);
    if (s.kind == SiteKind::Trace && s.trace->records.call) {
        if (const auto light = recorded(c, s, point, f, raysOfTrace(s, f, p), occurrence)) {
            settled_.push_back({target, weight * *light * (owns ? Color(1) : p.ray->weight), LightEvent::Sampled, p.ray,
                                owns ? -1 : extraOf(*p.ray).share});
            if (!owns) settled_.back().end = pathEvent(p.ray->path, object_);
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
    if (world_->lightsAsk()) {
        l.lit = int(litValues_.size());
        litValues_.push_back(litValues(c, s, point, f));
    }
    if (s.kind == SiteKind::Subsurface) {
        requestSubsurface(c, s, p, f, l);
        l.place = lobeRows_.add(*l.kind, {p.surface.n, params.wo, {}, 0});
        return;
    }
    if (s.kind != SiteKind::Diffuse) params.wo = normalizeOr(-p.I, p.surface.n);
    switch (s.kind) {
    case SiteKind::Diffuse:
        params.axis = directionOr(v(0), p.surface.n);
        l.rays = &kDiffuseKind;
        if (s.trace && s.trace->apart) l.indirect = 0; // indirectdiffuse() brings what surfaces send
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
            counters.ignored += uint64_t(l.samples);
            lobes.pop_back();
            return;
        }
        if (s.trace->hemisphere) noteTurnedAway(c, s, point, params.axis);
        break;
    default:
        break;
    }
    const DistributionParams more = l.kind->distribution ? distributionOf(s, *kind, f) : DistributionParams();
    l.place = lobeRows_.add(*l.kind, params, l.kind->distribution ? &more : nullptr);
}

Color Engine::mapTowards(const TraceSite& t, const Vec3& w, float spread) const {
    const Vec3 at(transformVector(t.toMap, Vec3d(w)));
    const Basis b(directionOr(at, Vec3(0, 0, 1)));
    float v[3] = {};
    texture::LookupOptions colours;
    colours.asLight = true;
    texture::environment(t.map, world_->textures_->latLong(), 0, 3, at, b.t * spread, b.u * spread, colours, v);
    return {v[0], v[1], v[2]};
}

void Engine::gather(BatchContext& c, Sched& sched) {
    if (!ambients_.empty()) gatherAmbient(c);
    std::unique_ptr<Gather> g = std::move(gather_); // taken, so that one inside of this has its own
    if (!g) g = std::make_unique<Gather>(*this);
    g->run(c, sched);
    apartAt_.clear();
    gather_ = std::move(g);
    if (!below_.empty()) walk(c, sched);
}

} // namespace alpenglow::transport

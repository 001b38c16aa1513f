// Emission: light of emitters that rays hit, and of skies behind escaped rays.
#include "integrator/emittedlight.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/gathercalls.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/lightsample.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/medium.h"
#include "integrator/photonstage.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "world/skysampler.h"
#include <algorithm>

namespace alpenglow::integrator {

EmittedLight::EmittedLight(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), lightKernels_(s.lightKernels), paths_(s.paths), litSurfaces_(s.litSurfaces),
      media_(s.media), mediumEvents_(s.mediumEvents), photons_(s.photons), store_(s.store), shadows_(s.shadows),
      gathers_(s.gathers) {}

/// 0 where the shadow ray has all of the weight (ShadowRays::takeAlone).
Color EmittedLight::differentShadow(const PathRay& r, float distance) {
    if (r.passed && r.shadowDiffers) return Color(0);
    const std::vector<uint8_t>& only = world_.shadowVisibility().shadowsOnly[r.type() == RayType::Specular];
    if (only.empty()) return Color(1);
    RayKind kind = kShadowKind;
    kind.set.only = only.data();
    ShadowRay way{};
    way.origin = r.lobeOrigin + r.dir * geometry::roundingError(r.lobeOrigin);
    way.dir = r.dir;
    way.distance = distance * (1 - 1e-5f);
    way.time = world_.shutterOf(r);
    way.ray = &r;
    way.kind = store_.kindOf(kind);
    return shadows_.transmittance(way);
}

/// Density of light samples at the origin of a ray in direction w; pdf: of the light alone.
float EmittedLight::mixedPdf(const PathRay& r, const BoundLight& l, float pdf, const Vec3& w) const {
    const LightGuide* guide = rules_.pickOne ? guideOf(world_, l) : nullptr;
    if (!guide || store_.extraOf(r).flown.medium >= 0 || (l.guidable && r.first)) return pdf;
    const LightGuide::Cell* cell = guide->find(r.lobeOrigin);
    return cell ? guide->mixed(*cell, pdf, r.lobeOrigin, w) : pdf;
}

void EmittedLight::misses(std::span<const Sched::Task* const> tasks, Sched& sched) {
    for (const Sched::Task* t : tasks) // the environment map of a trace()
        if (const PathRay& r = t->payload; maxComponent(store_.extraOf(r).environment) > 0) {
            accumulator_.contribute(sched, {t->target, r.weight * store_.extraOf(r).environment, LightEvent::Map, &r,
                                            store_.extraOf(r).share, nullptr, paths_.next(r.path, paths_.map)});
            if (TraceSums* sums = accumulator_.sumsOf(t->target))
                sums->add(TraceSums::Environment, r.weight * store_.extraOf(r).environment);
        }
    if (photons_.photonTrace() || tasks.empty()) return;
    std::vector<ShadePoint> q;
    std::vector<const Sched::Task*> of;
    std::vector<LightValue> value;
    for (const int number : world_.skies()) {
        const BoundLight& l = world_.lights()[size_t(number)];
        if (l.kind == LightKind::Ambient) continue; // ambient() handles it
        // Under the other hiders a sky is either a light of loops or a background for rays.
        if (!rules_.emissionCounts && (l.kind != LightKind::Environment || l.strategy != LightStrategy::Trace)) continue;
        q.clear();
        of.clear();
        litBy_.clear();
        for (const Sched::Task* t : tasks) {
            const PathRay& r = t->payload;
            if (!l.seenBy(*r.kind)) continue;
            if (l.shadowless && l.sky && r.lobePdf >= 0) continue; // its samples bring all of it
            // For a lobe that samples lights: a light that is off for its surface does not light it by chance either.
            if (r.lobeBinding >= 0 && !world_.bindings()[size_t(r.lobeBinding)].lights.contains(number)) continue;
            if (photons_.bringsPhotons(r, number) || (r.guided() && !(r.trail & shading::kTrailMirrored))) continue;
            ShadePoint& p = q.emplace_back();
            p.Ps = r.origin;
            p.P = r.origin + r.dir;
            p.N = -r.dir;
            p.shutter = world_.shadesAtOpen() ? 0 : r.shutter();
            world_.setTime(p);
            p.ray = &r;
            of.push_back(t);
            litBy_.push_back(store_.extraOf(r).lit);
            if (l.asksSurface && litBy_.back() >= 0) { // a light without area has the normal of the lit point
                litSurfaces_.tellPoint(p, litBy_.back());
                p.N = p.Ns;
            }
        }
        value.assign(q.size(), {});
        LitSurface lit;
        if (l.asksSurface) lit = litSurfaces_.querying(litBy_);
        lightKernels_.evaluateLight(l, q, value, {.lit = l.asksSurface ? &lit : nullptr});
        for (size_t i = 0; i < of.size(); ++i)
            if (value[i].lit) {
                const PathRay& r = of[i]->payload;
                const bool weighed = r.bounces > 0 && !r.kind->fromTrace; // hit by a lobe of a lighting shadeop
                float weight = weighed ? value[i].kept(r.type()) : 1.f;
                if (r.lobePdf < 0) weight *= -r.lobePdf;
                if (l.isSky() && r.lobePdf >= 0) { // its lobe may have sampled this sky
                    float pdf = l.sky ? l.sky->pdf(r.dir) : 0;
                    if (context_.seen && l.guidable && luminance(value[i].Cl) > 0) {
                        const float light = luminance(value[i].Cl);
                        context_.seen->push_back({{r.lobeOrigin, r.dir, light, light / r.lobePdf, pdf}, number});
                    }
                    pdf = mixedPdf(r, l, pdf, r.dir);
                    if (l.sky && rules_.pickOne && r.lobeBinding >= 0)
                        pdf *= lightKernels_.chanceOf(number, r.lobeBinding, r.lobeOrigin, r.bounces - 1);
                    weight *= world_.settings().lightOnly ? 0 : misWeight(r.lobePdf, pdf);
                    if (pdf > 0 && world_.shadowVisibility().differs()) value[i].Cl *= differentShadow(r, 1e38f);
                }
                const Color light = r.weight * value[i].Cl * weight;
                accumulator_.contribute(sched, {of[i]->target, light, LightEvent::Sky, &r, store_.extraOf(r).share,
                                                l.instance.get(), paths_.atLight(r.path, l)});
            }
    }
}

void EmittedLight::emission(std::span<const Met> met, Sched& sched) {
    const Settings& set = world_.settings();
    std::vector<ShadePoint> q;
    std::vector<LightValue> value;
    for (size_t first = 0, end; first < met.size(); first = end) {
        q.clear();
        litBy_.clear();
        const auto sending = [&](size_t i) { return gathers_.sending(met[i].target, rsl::PairName::To::Light); };
        const GatherSent* const ray = sending(first); // what it sends is for its own hit
        for (end = first; end < met.size() && met[end].light == met[first].light && sending(end) == ray; ++end) {
            const PathRay& r = *met[end].point->ray;
            q.push_back(*met[end].point);
            ShadePoint& p = q.back();
            p.P = intersectsAt(p.surface);
            p.N = p.surface.n;
            p.Ps = r.lobePdf >= 0 ? r.lobeOrigin : r.volumeBegin();
            litBy_.push_back(store_.extraOf(r).lit);
        }
        const BoundLight& light = world_.lights()[size_t(met[first].light)];
        for (size_t i = 0; light.asksSurface && i < q.size(); ++i) litSurfaces_.tellPoint(q[i], litBy_[i]);
        value.assign(q.size(), {});
        LitSurface lit;
        if (light.asksSurface) lit = litSurfaces_.querying(litBy_);
        std::vector<char> inMedium;
        if (!world_.media().empty())
            for (size_t i = first; i < end; ++i) inMedium.push_back(met[i].point->ray->medium() >= 0);
        shading::ParameterBlock given;
        const bool sent = ray && GatherCalls::lightParameters(*ray, *light.instance, given);
        lightKernels_.evaluateLight(light, q, value,
                                    {.parameters = sent ? &given : nullptr,
                                     .lit = light.asksSurface ? &lit : nullptr,
                                     .inMedium = inMedium.empty() ? nullptr : &inMedium});
        for (size_t i = 0; i < inMedium.size(); ++i) {
            if (!inMedium[i] || !value[i].lit) continue;
            const PathRay& r = *met[first + i].point->ray;
            if (world_.media()[size_t(r.medium())].homogeneous) continue; // its flight has handled it
            const MediumPart part{r.medium(), 0, r.volumeBegin(), met[first + i].point->P};
            ShadowRay way{};
            way.ray = &r;
            way.time = world_.shutterOf(r);
            media_.dim({&part, 1}, {&way, 1}, {&value[i].Cl, 1});
        }
        for (size_t i = first; i < end; ++i) {
            LightValue& v = value[i - first];
            const ShadePoint& p = *met[i].point;
            const PathRay& r = *p.ray;
            if (v.lit && !isFinite(v.Cl)) accumulator_.notFinite(&r, "Cl", light.instance.get());
            if (!v.lit || v.Cl == Color(0) || !isFinite(v.Cl) || photons_.bringsPhotons(r, met[i].light)) continue;
            if (light.shadowless && r.lobePdf >= 0) continue; // its samples bring all of it
            float weight = r.lobePdf < 0 ? -r.lobePdf : 1;
            if (r.lobePdf >= 0 && light.emitter && light.importance) {
                float pdf = light.emitter->pdf(p.shape, p.surface, r.lobeOrigin);
                const Vec3 w = normalizeOr(intersectsAt(p.surface) - r.lobeOrigin, r.dir);
                pdf = mixedPdf(r, light, pdf, w);
                if (rules_.pickOne && r.lobeBinding >= 0)
                    pdf *= lightKernels_.chanceOf(met[i].light, r.lobeBinding, r.lobeOrigin, r.bounces - 1);
                weight = set.lightOnly ? 0 : misWeight(r.lobePdf, pdf);
                if (pdf > 0 && world_.shadowVisibility().differs())
                    v.Cl *= differentShadow(r, length(intersectsAt(p.surface) - r.lobeOrigin));
            }
            if (const FreeFlight& flown = store_.extraOf(r).flown; flown.medium >= 0 && r.lobeBinding >= 0)
                weight *= mediumEvents_.shareOfDistance(flown, light);
            if (r.bounces > 0 && !r.kind->fromTrace) weight *= v.kept(r.type());
            accumulator_.contribute(sched, {met[i].target, r.weight * v.Cl * weight, LightEvent::Met, &r, store_.extraOf(r).share,
                                            light.instance.get(), paths_.atLight(r.path, light)});
            if (TraceSums* sums = accumulator_.sumsOf(met[i].target); sums && maxComponent(store_.extraOf(r).part) > 0)
                sums->add(TraceSums::AreaLight, r.weight * v.Cl * weight);
        }
    }
}

/// Adds the light of the emitters among the points.
void EmittedLight::hits(const BatchContext& c, Sched& sched) {
    std::vector<Met> met;
    for (size_t i = 0; i < c.points.size(); ++i) {
        const SurfaceBinding& b = world_.bindings()[size_t(c.bindings[i])];
        const PathRay& r = c.rays[i];
        if (b.areaLight < 0 || (b.matte && r.camera()) || (r.guided() && !(r.trail & shading::kTrailMirrored))) continue;
        if (!rules_.emissionCounts && r.lobePdf < 0 && !r.kind->asksLights) continue;
        if (r.lobeBinding >=
            0) { // a lobe that samples lights: a light that is off for its surface does not light it by chance either
            if (!world_.bindings()[size_t(r.lobeBinding)].lights.contains(b.areaLight)) continue;
        }
        const BoundLight& light = world_.lights()[size_t(b.areaLight)];
        if (light.mean || !light.seenBy(*r.kind)) continue;
        met.push_back({b.areaLight, c.targets[i], &c.points[i]});
        for (int part : light.parts)
            if (world_.lights()[size_t(part)].kind == LightKind::Area) met.push_back({part, c.targets[i], &c.points[i]});
    }
    std::stable_sort(met.begin(), met.end(), [](const Met& a, const Met& b) { return a.light < b.light; });
    emission(met, sched);
}

} // namespace alpenglow::integrator

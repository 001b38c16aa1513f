// Stage LastSkies: at the depth limit of a path lamps are still sampled; a sky that is not sampled as a light must count as well.
// The ray that would have reached it becomes a shadow ray with the light of the sky alone.
#include "integrator/lastskies.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/requests.h"
#include "integrator/scatterrays.h"
#include "integrator/shadowrays.h"

namespace alpenglow::integrator {

LastSkies::LastSkies(const StageSet& s, const VertexLobes& v, ScatterRays& scatter)
    : VertexStage(s, v), scatter_(scatter), accumulator_(s.accumulator), lightKernels_(s.lightKernels), paths_(s.paths),
      litSurfaces_(s.litSurfaces), media_(s.media), shadows_(s.shadows) {}

void LastSkies::run() {
    scatter_.sent.clear();
    if (world_.skies_.empty()) return;
    for (size_t point = 0; point < c_->points.size(); ++point)
        for (int i : lobesOf(point)) {
            const LobeVertex& l = requests_.lobes[size_t(i)];
            // The same lobes as for lamps: those that sample lights.
            if (l.last && l.lights && !l.elsewhere && !l.delta) scatter_.sent.push_back({int(point), i, 1, 1, true, Vec3(), {}});
        }
    if (scatter_.sent.empty()) return;
    scatter_.draw(0);
    for (const int number : world_.skies_) {
        const BoundLight& light = world_.lights_[size_t(number)];
        if (!light.sky && light.kind != LightKind::Ambient) lastSky(number); // ambient() handles ambient light
    }
}

void LastSkies::lastSky(int number) {
    const BoundLight& light = world_.lights_[size_t(number)];
    std::vector<ShadePoint> q;
    std::vector<const LobeRay*> of;
    std::vector<int> told;
    for (const LobeRay& s : scatter_.sent) {
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        const ShadePoint& at = c_->points[size_t(s.point)];
        if (!s.goes || !(s.value.pdf > 0)) continue;
        if (!light.seenBy(*l.rays)) continue;
        if (!world_.bindings_[size_t(c_->bindings[size_t(s.point)])].lights.contains(number)) continue;
        ShadePoint& p = q.emplace_back();
        p.Ps = origin(l, s.w);
        p.P = p.Ps + s.w;
        p.N = -s.w;
        p.shutter = at.shutter;
        p.time = at.time;
        p.ray = &rayOf(l);
        of.push_back(&s);
        told.push_back(l.lit);
    }
    std::vector<LightValue> value(q.size());
    LitSurface lit;
    if (light.asksSurface) lit = litSurfaces_.litBy(told);
    lightKernels_.evaluateLight(light, q, value, {.lit = light.asksSurface ? &lit : nullptr});
    for (size_t k = 0; k < of.size(); ++k) {
        const LobeRay& s = *of[k];
        const LobeVertex& l = requests_.lobes[size_t(s.lobe)];
        const PathRay& ray = rayOf(l);
        if (!value[k].lit) continue;
        if (!isFinite(value[k].Cl)) {
            accumulator_.notFinite(&ray, "Cl", light.instance.get());
            continue;
        }
        float scale = 1; // direct light counts in full; only light of surfaces is scaled
        if (light.kind == LightKind::Environment && !l.rays->fromTrace) scale *= value[k].kept(l.rays->type);
        const Color weight = l.weight * (s.value.colour / s.value.pdf) * scale;
        ShadowRay shadow{q[k].Ps,  s.w,          l.maxDistance, (l.ownsTarget ? weight : weight * ray.weight) * value[k].Cl,
                         l.target, q[k].shutter, &ray};
        shadow.kind = l.rays; // visibility as for the replaced ray
        shadow.media = media_.towards(*c_, s.point, s.w);
        shadow.share = shareOf(l);
        shadow.path = paths_.atLobe(l, c_->points[size_t(s.point)], ray, s.w);
        if (shadow.path) shadow.light = paths_.lights[size_t(number)];
        shadows_.queue.push_back(shadow);
    }
}

} // namespace alpenglow::integrator

#include "integrator/lastskies.h"
#include "integrator/accumulator.h"
#include "integrator/lightkernels.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/shadowrays.h"

namespace alpenglow::integrator {

LastSkies::LastSkies(const StageSet& s)
    : Stage(s.context), accumulator_(s.accumulator), lightKernels_(s.lightKernels), paths_(s.paths), litSurfaces_(s.litSurfaces),
      media_(s.media), shadows_(s.shadows) {
    for (const int number : world_.skies()) {
        const BoundLight& light = world_.lights()[size_t(number)];
        if (!light.sky && light.kind != LightKind::Ambient) skies_.push_back(number); // ambient() handles ambient light
    }
}

void LastSkies::send(const BatchContext& c, std::span<const LastRay> rays) {
    for (const int number : skies_) send(c, rays, number);
}

void LastSkies::send(const BatchContext& c, std::span<const LastRay> rays, int number) {
    const BoundLight& light = world_.lights()[size_t(number)];
    std::vector<ShadePoint> q;
    std::vector<const LastRay*> of;
    std::vector<int> surfaces;
    for (const LastRay& r : rays) {
        if (!light.seenBy(*r.kind)) continue;
        if (!world_.bindings()[size_t(c.bindings[size_t(r.point)])].lights.contains(number)) continue;
        const ShadePoint& at = c.points[size_t(r.point)];
        ShadePoint& p = q.emplace_back();
        p.Ps = r.origin;
        p.P = p.Ps + r.direction;
        p.N = -r.direction;
        p.shutter = at.shutter;
        p.time = at.time;
        p.ray = &c.rays[size_t(r.point)];
        of.push_back(&r);
        surfaces.push_back(r.lit);
        if (light.asksSurface && r.lit >= 0) {
            litSurfaces_.tellPoint(p, r.lit);
            p.N = p.Ns;
        }
    }
    std::vector<LightValue> value(q.size());
    LitSurface lit;
    if (light.asksSurface) lit = litSurfaces_.querying(surfaces);
    lightKernels_.evaluateLight(light, q, value, {.lit = light.asksSurface ? &lit : nullptr});
    for (size_t k = 0; k < of.size(); ++k) {
        const LastRay& r = *of[k];
        const PathRay& ray = c.rays[size_t(r.point)];
        if (!value[k].lit) continue;
        if (!isFinite(value[k].Cl)) {
            accumulator_.notFinite(&ray, "Cl", light.instance.get());
            continue;
        }
        float scale = 1; // direct light counts in full; only light of surfaces is scaled
        if (light.kind == LightKind::Environment && !r.kind->fromTrace) scale *= value[k].kept(r.kind->type);
        ShadowRay shadow{q[k].Ps, r.direction, r.maxDistance, r.weight * scale * value[k].Cl, r.target, q[k].shutter, &ray};
        shadow.kind = r.kind; // visibility as for the replaced ray
        shadow.media = media_.towards(c, r.point, r.direction);
        shadow.share = r.share;
        shadow.path = r.path;
        if (shadow.path) shadow.light = paths_.lights[size_t(number)];
        shadows_.queue.push_back(shadow);
    }
}

} // namespace alpenglow::integrator

#include "integrator/unshadowed.h"
#include "integrator/intersector.h"
#include "integrator/lightkernels.h"
#include "integrator/litsurfaces.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

UnshadowedLight::UnshadowedLight(const StageSet& s)
    : Stage(s.context), intersector_(s.intersector), lightKernels_(s.lightKernels), litSurfaces_(s.litSurfaces) {}

void UnshadowedLight::add(const BatchContext& c, const UnshadowedRay& r, const Color& through, const Color& environment,
                          TraceSums& sums) {
    const shading::RaySet& set = r.rays->set;
    const PathRay& from = c.rays[size_t(r.point)];
    const ShadePoint& p = c.points[size_t(r.point)];
    accel::Ray ray;
    ray.org = r.origin;
    ray.dir = r.direction;
    ray.tfar = r.maxDistance;
    ray.time = world_.shutterOf(from);
    ray.mask = visibilityBit(r.rays->type);
    ray.sides = set.sides;
    ray.only = world_.shining().data();
    ray.level = from.sample->level;
    accel::Hit hit;
    while (intersector_.intersect(ray, hit) && set.only && !set.only[hit.shape]) world_.goOn(ray, hit);
    if (!hit.valid()) return sums.add(TraceSums::UnshadowedEnvironment, through * environment);
    if (!r.bringsEmission) return; // light samples estimate area lights
    const auto isOn = [&](int light) {
        const BoundLight& b = world_.lights()[size_t(light)];
        return b.kind == LightKind::Area && !b.mean && b.strategy != LightStrategy::Illuminance;
    };
    const int light = world_.shapes()[hit.shape]->attributes().areaLight;
    if (!world_.bindings()[size_t(c.bindings[size_t(r.point)])].lights.contains(light)) return;
    std::vector<int> all{light};
    for (int part : world_.lights()[size_t(light)].parts) all.push_back(part);
    for (int number : all) {
        if (!isOn(number)) continue;
        const BoundLight& b = world_.lights()[size_t(number)];
        std::vector<ShadePoint> q(1);
        q[0].shape = world_.shapes()[hit.shape].get();
        world_.accel().point(hit, q[0].surface, b.pointNeeds);
        q[0].P = intersectsAt(q[0].surface);
        q[0].N = q[0].surface.n;
        q[0].Ps = r.lit;
        q[0].shutter = p.shutter;
        q[0].time = p.time;
        q[0].ray = &from;
        const std::vector<int> surfaces{r.litSurface};
        LitSurface surface;
        if (b.asksSurface) surface = litSurfaces_.querying(surfaces);
        LightValue v;
        lightKernels_.evaluateLight(b, q, {&v, 1}, {.lit = b.asksSurface ? &surface : nullptr});
        if (v.lit && isFinite(v.Cl)) sums.add(TraceSums::UnshadowedAreaLight, through * v.Cl);
    }
}

} // namespace alpenglow::integrator

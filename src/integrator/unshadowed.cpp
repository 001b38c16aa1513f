#include "integrator/unshadowed.h"
#include "integrator/batchcontext.h"
#include "integrator/intersector.h"
#include "integrator/lightkernels.h"
#include "integrator/litsurfaces.h"
#include "integrator/stageset.h"
#include "integrator/vertex.h"

namespace alpenglow::integrator {

UnshadowedLight::UnshadowedLight(const StageSet& s)
    : Stage(s.context), intersector_(s.intersector), lightKernels_(s.lightKernels), litSurfaces_(s.litSurfaces) {}

void UnshadowedLight::add(const BatchContext& c, const LobeVertex& l, bool lamps, const Vec3& origin, const Vec3& w,
                          const Color& through, const Color& environment, TraceSums& sums) {
    const shading::RaySet& set = l.rays->set;
    const PathRay& from = c.rays[size_t(l.point)];
    const ShadePoint& p = c.points[size_t(l.point)];
    accel::Ray ray;
    ray.org = origin;
    ray.dir = w;
    ray.tfar = l.maxDistance;
    ray.time = world_.shutterOf(from);
    ray.mask = visibilityBit(l.rays->type);
    ray.sides = set.sides;
    ray.only = world_.shining_.data();
    ray.level = from.sample->level;
    accel::Hit hit;
    while (intersector_.intersect(ray, hit) && set.only && !set.only[hit.shape]) world_.goOn(ray, hit);
    if (!hit.valid()) return sums.add(TraceSums::UnshadowedEnvironment, through * environment);
    const auto isOn = [&](int light) {
        const BoundLight& b = world_.lights_[size_t(light)];
        return b.kind == LightKind::Area && !b.mean && b.strategy != LightStrategy::Illuminance;
    };
    const int light = world_.shapes_[hit.shape]->attributes().areaLight;
    const SurfaceBinding& lit = world_.bindings_[size_t(c.bindings[size_t(l.point)])];
    if (!lamps || !lit.lights.contains(light)) return;
    std::vector<int> all{light};
    for (int part : world_.lights_[size_t(light)].parts) all.push_back(part);
    for (int number : all) {
        if (!isOn(number)) continue;
        const BoundLight& b = world_.lights_[size_t(number)];
        std::vector<ShadePoint> q(1);
        q[0].shape = world_.shapes_[hit.shape].get();
        world_.accel_->point(hit, q[0].surface, b.pointNeeds);
        q[0].P = intersectsAt(q[0].surface);
        q[0].N = q[0].surface.n;
        q[0].Ps = l.elsewhere ? l.from : p.P;
        q[0].shutter = p.shutter;
        q[0].time = p.time;
        q[0].ray = &from;
        const std::vector<int> told{l.lit};
        LitSurface surface;
        if (b.asksSurface) surface = litSurfaces_.litBy(told);
        LightValue v;
        lightKernels_.evaluateLight(b, q, {&v, 1}, {.lit = b.asksSurface ? &surface : nullptr});
        if (v.lit && isFinite(v.Cl)) sums.add(TraceSums::UnshadowedAreaLight, through * v.Cl);
    }
}

} // namespace alpenglow::integrator

// ambient() under path: light of ambient lights from the visible part of the hemisphere. Ambient light is uniform over all
// directions; a shadow ray in a cosine-distributed direction tests for occlusion.
#include "integrator/ambientlight.h"
#include "base/direction.h"
#include "bsdf/sampling.h"
#include "integrator/accumulator.h"
#include "integrator/context.h"
#include "integrator/lightkernels.h"
#include "integrator/lightpathstates.h"
#include "integrator/litsurfaces.h"
#include "integrator/mediastacks.h"
#include "integrator/raystore.h"
#include "integrator/shadowrays.h"
#include "integrator/stageset.h"
#include "integrator/surfacepoints.h"

namespace alpenglow::integrator {

static bool anyAmbient(const WorldImpl& w) {
    return std::any_of(w.skies().begin(), w.skies().end(),
                       [&](int l) { return w.lights()[size_t(l)].kind == LightKind::Ambient; });
}

AmbientLight::AmbientLight(const StageSet& s)
    : Stage(s.context), lights(anyAmbient(world_)), accumulator_(s.accumulator), lightKernels_(s.lightKernels), paths_(s.paths),
      litSurfaces_(s.litSurfaces), media_(s.media), store_(s.store), shadows_(s.shadows), surfaces_(s.surfaces) {}

/// Samples the directions of the calls. The random numbers are those of the vertex, whoever calls, so that kernels for parts of
/// Ci get the same directions.
void AmbientLight::draw(const BatchContext& c, std::vector<AmbientAsked>& calls) {
    numbers_.clear();
    for (const AmbientAsked& a : calls) {
        const PathRay& ray = c.rays[size_t(a.point)];
        numbers_.askPair(store_.random(ray).numbers(), ray.vertex, kAmbient, 0);
    }
    numbers_.draw();
    for (size_t i = 0; i < calls.size(); ++i) {
        AmbientAsked& a = calls[i];
        const ShadePoint& p = c.points[size_t(a.point)];
        const Vec3 n = directionOr(a.way, p.surface.n);
        a.way = Basis(onSeenSide(n, p, c.rays[size_t(a.point)].dir)).toWorld(sampleCosine(numbers_.pair(i)));
        if (a.lit >= 0) litSurfaces_.recordOutputs(litSurfaces_.values[size_t(a.lit)], c, size_t(a.point));
    }
}

/// Sends the light of one ambient light along the shadow ray of a call. Lights that light path outputs distinguish have rays of
/// their own; the others share that of `last`, the index of a shadow ray or -1.
void AmbientLight::send(const BatchContext& c, const AmbientAsked& a, const Color& light, int number, int& last) {
    const PathRay& ray = c.rays[size_t(a.point)];
    const int32_t share = a.owns ? -1 : store_.extraOf(ray).share;
    if (last >= 0) {
        ShadowRay& first = shadows_.queue[size_t(last)];
        shadows_.more.push_back({a.weight * light, a.target, share, false, 0, first.more});
        first.more = int32_t(shadows_.more.size()) - 1;
        return;
    }
    const ShadePoint& p = c.points[size_t(a.point)];
    ShadowRay& shadow = shadows_.queue.emplace_back();
    shadow.origin = surfaces_.leave(c, size_t(a.point), a.way);
    shadow.dir = a.way;
    shadow.distance = 1e38f;
    shadow.contribution = a.weight * light;
    shadow.target = a.target;
    shadow.time = p.shutter;
    shadow.ray = p.ray;
    shadow.media = media_.towards(c, a.point, a.way);
    shadow.share = share;
    if (!a.owns && ray.path) {
        shadow.path = paths_.atLoop(p, ray, a.way, paths_.ambientLabel);
        shadow.light = paths_.lights[size_t(number)];
    } else {
        last = int(shadows_.queue.size()) - 1;
    }
}

void AmbientLight::gather(BatchContext& c) {
    std::vector<AmbientAsked> calls;
    calls.swap(asked); // a light's kernel may trace
    std::vector<int> sent(calls.size(), -1);
    std::vector<ShadePoint> queries;
    std::vector<size_t> of;
    std::vector<LightValue> value;
    draw(c, calls);
    for (const int number : world_.skies()) {
        const BoundLight& l = world_.lights()[size_t(number)];
        if (l.kind != LightKind::Ambient) continue;
        queries.clear();
        of.clear();
        litBy_.clear();
        for (size_t i = 0; i < calls.size(); ++i) {
            const size_t point = size_t(calls[i].point);
            if (!world_.bindings()[size_t(c.bindings[point])].lights.contains(number)) continue;
            ShadePoint& q = queries.emplace_back(c.points[point]);
            q.Ps = q.P;
            q.Ns = q.N;
            q.lit = &c.points[point].surface;
            q.shape = nullptr;
            of.push_back(i);
            litBy_.push_back(calls[i].lit);
        }
        value.assign(queries.size(), {});
        LitSurface lit;
        if (l.asksSurface) lit = litSurfaces_.querying(litBy_);
        lightKernels_.evaluateLight(l, queries, value, {.lit = l.asksSurface ? &lit : nullptr});
        for (size_t k = 0; k < of.size(); ++k) {
            const AmbientAsked& a = calls[of[k]];
            const Color& light = value[k].Cl;
            if (!value[k].lit || light == Color(0)) continue;
            if (!isFinite(light)) accumulator_.notFinite(&c.rays[size_t(a.point)], "Cl", l.instance.get());
            else send(c, a, light, number, sent[of[k]]);
        }
    }
}

} // namespace alpenglow::integrator

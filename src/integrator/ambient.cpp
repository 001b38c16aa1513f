// ambient() under path: what of the ambient lights reaches a point from the hemisphere that is seen. The lights shine from
// everywhere evenly; a shadow ray in a direction drawn by the cosine says whether a surface is before them.
#include "base/direction.h"
#include "integrator/engine.h"
#include "lobes/sampling.h"

namespace alpenglow::transport {

/// Turns what was asked for into directions: those of the vertex, whatever asks, so that parts of Ci that ask by themselves find
/// the same.
void Engine::drawAmbient(const BatchContext& c, std::vector<AmbientAsked>& asked) {
    ambientNumbers_.clear();
    for (const AmbientAsked& a : asked) {
        const PathRay& ray = c.rays[size_t(a.point)];
        ambientNumbers_.askPair(random(ray).numbers(), ray.vertex, kAmbient, 0);
    }
    ambientNumbers_.draw();
    for (size_t i = 0; i < asked.size(); ++i) {
        AmbientAsked& a = asked[i];
        const ShadePoint& p = c.points[size_t(a.point)];
        const Vec3 n = directionOr(a.way, p.surface.n);
        a.way = Basis(onSeenSide(n, p, c.rays[size_t(a.point)].dir)).toWorld(sampleCosine(ambientNumbers_.pair(i)));
        if (a.lit >= 0) tellOutputs(litValues_[size_t(a.lit)], c, size_t(a.point));
    }
}

/// Sends the light of an ambient light along the ray of a call. Lights that outputs tell apart have rays of their own; the others
/// share that of `last`, the number of a shadow ray or -1.
void Engine::sendAmbient(const BatchContext& c, const AmbientAsked& a, const Color& light, int number, int& last) {
    const PathRay& ray = c.rays[size_t(a.point)];
    const int32_t share = a.owns ? -1 : extraOf(ray).share;
    if (last >= 0) {
        ShadowRay& first = shadows[size_t(last)];
        moreLight_.push_back({a.weight * light, a.target, share, false, 0, first.more});
        first.more = int32_t(moreLight_.size()) - 1;
        return;
    }
    const ShadePoint& p = c.points[size_t(a.point)];
    ShadowRay& shadow = shadows.emplace_back();
    shadow.origin = leave(c, size_t(a.point), a.way);
    shadow.dir = a.way;
    shadow.distance = 1e38f;
    shadow.contribution = a.weight * light;
    shadow.target = a.target;
    shadow.time = p.shutter;
    shadow.ray = p.ray;
    shadow.media = mediaTowards(c, a.point, a.way);
    shadow.share = share;
    if (!a.owns && ray.path) {
        shadow.path = atLoop(p, ray, a.way, ambientLabel_);
        shadow.light = lightSymbols_[size_t(number)];
    } else {
        last = int(shadows.size()) - 1;
    }
}

void Engine::gatherAmbient(BatchContext& c) {
    std::vector<AmbientAsked> asked;
    asked.swap(ambients_); // a light's kernel may trace
    std::vector<int> sent(asked.size(), -1);
    std::vector<ShadePoint> queries;
    std::vector<size_t> of;
    std::vector<LightValue> value;
    drawAmbient(c, asked);
    for (const int number : world_->skies_) {
        const BoundLight& l = world_->lights_[size_t(number)];
        if (l.kind != LightKind::Ambient) continue;
        queries.clear();
        of.clear();
        litBy_.clear();
        for (size_t i = 0; i < asked.size(); ++i) {
            const size_t point = size_t(asked[i].point);
            if (!world_->bindings_[size_t(c.bindings[point])].lights.contains(number)) continue;
            ShadePoint& q = queries.emplace_back(c.points[point]);
            q.Ps = q.P;
            q.Ns = q.N;
            q.lit = &c.points[point].surface;
            q.shape = nullptr;
            of.push_back(i);
            litBy_.push_back(asked[i].lit);
        }
        value.assign(queries.size(), {});
        LitSurface lit;
        if (l.asksSurface) lit = litBy(litBy_);
        evaluateLight(l, queries, value, {.lit = l.asksSurface ? &lit : nullptr});
        for (size_t k = 0; k < of.size(); ++k) {
            const AmbientAsked& a = asked[of[k]];
            const Color& light = value[k].Cl;
            if (!value[k].lit || light == Color(0)) continue;
            if (!isFinite(light)) notFinite(&c.rays[size_t(a.point)], "Cl", l.instance.get());
            else sendAmbient(c, a, light, number, sent[of[k]]);
        }
    }
}

} // namespace alpenglow::transport

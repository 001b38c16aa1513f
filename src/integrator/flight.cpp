// Stage fly. Where nothing can happen it costs nothing.
#include "integrator/flight.h"
#include "integrator/engine.h"

namespace alpenglow::transport {

void BatchContext::move(size_t from, size_t to) {
    if (from == to) return;
    points[to] = points[from];
    rays[to] = rays[from];
    targets[to] = targets[from];
    bindings[to] = bindings[from];
    hits[to] = hits[from];
    if (!depths.empty()) depths[to] = depths[from];
    points[to].ray = &rays[to];
}

void BatchContext::keepFirst(size_t count) {
    points.resize(count);
    rays.resize(count);
    targets.resize(count);
    bindings.resize(count);
    hits.resize(count);
    if (!depths.empty()) depths.resize(count);
}

void Engine::fly(BatchContext& c, Sched& sched) {
    if (events_.empty()) return;
    flights_.clear();
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const ShadePoint& p = c.points[i];
        const Vec3& at = p.surface.displaced ? p.surface.displacedP : p.surface.P; // rays meet facets
        flights_.push_back({&c.rays[i], c.targets[i], length(at - c.rays[i].origin), &p, c.bindings[i]});
    }
    for (FlightEvent* e : events_) e->happen(*this, flights_, sched);
    size_t kept = 0;
    for (size_t i = 0; i < flights_.size(); ++i) {
        if (flights_[i].over) {
            freeExtra(c.rays[i]);
            sched.release(c.targets[i]);
            continue;
        }
        PathRay& r = c.rays[i];
        r.weight *= flights_[i].left;
        if (r.extra >= 0) extras_[size_t(r.extra)].whole *= flights_[i].left;
        c.move(i, kept++);
    }
    c.keepFirst(kept);
}

void Engine::fly(std::vector<const Sched::Task*>& missed, Sched& sched) {
    if (events_.empty() || missed.empty()) return;
    flights_.clear();
    for (const Sched::Task* t : missed) flights_.push_back({&t->payload, t->target, t->payload.maxDistance});
    for (FlightEvent* e : events_) e->happen(*this, flights_, sched);
    size_t kept = 0;
    for (size_t i = 0; i < missed.size(); ++i) {
        if (flights_[i].over) freeExtra(missed[i]->payload);
        else missed[kept++] = missed[i];
    }
    missed.resize(kept);
}

void Engine::divert(Flight& f, PathRay next, Sched& sched, float way) {
    next.trail = photonTrace_ ? shading::kTrailSpread : 0; // photons do not come this way
    RayExtra extra = extraOf(*f.ray);                      // each ray has its own
    if (extra.fade.fades()) extra.way += way;
    next.extra = newExtra(extra);
    sched.spawn(next.bounces + next.layers, f.target, next);
    f.over = true;
}

} // namespace alpenglow::transport

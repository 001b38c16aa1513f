// Runs the events between hit and shader. Costs nothing without events.
#include "integrator/segmentevents.h"
#include "integrator/context.h"
#include "integrator/guiderays.h"
#include "integrator/photonstage.h"
#include "integrator/raysegment.h"
#include "integrator/raystore.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

SegmentEvents::SegmentEvents(const StageSet& s) : Stage(s.context), guide_(s.guide), photons_(s.photons), store_(s.store) {}

void SegmentEvents::run(BatchContext& c, Sched& sched) {
    if (events.empty()) return;
    list_.clear();
    for (size_t i = 0; i < c.rays.size(); ++i) {
        const ShadePoint& p = c.points[i];
        const Vec3& at = p.surface.displaced ? p.surface.displacedP : p.surface.P; // rays hit facets
        list_.push_back({&c.rays[i], c.targets[i], length(at - c.rays[i].origin), &p, c.bindings[i]});
    }
    for (SegmentEvent* e : events) e->happen(list_, sched);
    size_t kept = 0;
    for (size_t i = 0; i < list_.size(); ++i) {
        if (list_[i].over) {
            store_.freeExtra(c.rays[i]);
            sched.release(c.targets[i]);
            continue;
        }
        PathRay& r = c.rays[i];
        r.weight *= list_[i].transmittance;
        if (r.extra >= 0) store_.ownExtra(r).whole *= list_[i].transmittance;
        c.move(i, kept++);
    }
    c.keepFirst(kept);
}

void SegmentEvents::run(std::vector<const Sched::Task*>& missed, Sched& sched) {
    if (events.empty() || missed.empty()) return;
    list_.clear();
    for (const Sched::Task* t : missed) list_.push_back({&t->payload, t->target, t->payload.maxDistance});
    for (SegmentEvent* e : events) e->happen(list_, sched);
    size_t kept = 0;
    for (size_t i = 0; i < missed.size(); ++i) {
        if (list_[i].over) store_.freeExtra(missed[i]->payload);
        else missed[kept++] = missed[i];
    }
    missed.resize(kept);
}

void SegmentEvents::spawn(RaySegment& f, PathRay next, Sched& sched, float way) {
    if (photons_.photonTrace()) next.trail = shading::kTrailSpread;
    else if (!guide_.on()) next.trail = 0; // photons do not scatter in media
    guide_.continueBehind(next, f.binding);
    RayExtra extra = store_.extraOf(*f.ray); // extras have a single owner
    if (extra.fade.fades()) extra.way += way;
    next.extra = store_.newExtra(extra);
    sched.spawn(next.bounces + next.layers, f.target, next);
    f.over = true;
}

} // namespace alpenglow::integrator

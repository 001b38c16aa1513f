// Runs the events between hit and shader (raysegment.h). Costs nothing without events.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/raysegment.h"

namespace alpenglow::integrator {

class GuideRays;
class PhotonStage;
class RayStore;
struct StageSet;

/// Runs what happens between two surfaces.
class SegmentEvents final : Stage {
public:
    explicit SegmentEvents(const StageSet&);
    /// Registers an event, before the first ray. It must outlive the pipeline.
    void happens(SegmentEvent& e) { events.push_back(&e); }
    /// Runs all events on the rays of a batch, or on rays without a hit, and removes the segments that they ended.
    void run(BatchContext&, Sched&);
    /// For rays without a hit.
    void run(std::vector<const Sched::Task*>& missed, Sched&);
    /// For events: ends the segment and sends its ray on as `next`, a copy with the changes (at least the vertex). way: distance
    /// covered, if it goes straight on.
    void spawn(RaySegment&, PathRay next, Sched&, float way = 0);

    std::vector<SegmentEvent*> events; ///< in their order; empty: none

private:
    std::vector<RaySegment> list_;
    const GuideRays& guide_;
    PhotonStage& photons_;
    RayStore& store_;
};

} // namespace alpenglow::integrator

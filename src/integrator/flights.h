// Runs the events between hit and shader (flight.h). Costs nothing without events.
#pragma once
#include "integrator/batchcontext.h"
#include "integrator/context.h"
#include "integrator/flight.h"

namespace alpenglow::transport {

class GuideRays;
class PhotonStage;
class RayStore;
struct StageSet;

class Flights final : Stage {
public:
    explicit Flights(const StageSet&);
    /// Registers an event, before the first ray. It must outlive the pipeline.
    void happens(FlightEvent& e) { events.push_back(&e); }
    /// Runs all events on the rays of a batch, or on rays without a hit, and removes the segments that they ended.
    void fly(BatchContext&, Sched&);
    void fly(std::vector<const Sched::Task*>& missed, Sched&);
    /// For events: ends the segment and sends its ray on as `next`, a copy with the changes (at least the vertex). way: distance
    /// covered, if it goes straight on.
    void divert(Flight&, PathRay next, Sched&, float way = 0);

    std::vector<FlightEvent*> events;

private:
    std::vector<Flight> list_;
    const GuideRays& guide_;
    PhotonStage& photons_;
    RayStore& store_;
};

} // namespace alpenglow::transport

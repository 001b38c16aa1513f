// Between hit and shader: what happens to rays on their way (flight.h). Where nothing can happen it costs nothing.
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
    /// From now on this may happen on the way of rays; before the first of them. It must outlive the pipeline.
    void happens(FlightEvent& e) { events.push_back(&e); }
    /// Flights that are over leave the batch, or the list.
    void fly(BatchContext&, Sched&);
    void fly(std::vector<const Sched::Task*>& missed, Sched&);
    /// For events: the flight is over, and its ray goes on as `next`, a copy of it with what has changed (at least the vertex).
    /// way: how far it has come, where it goes straight on.
    void divert(Flight&, PathRay next, Sched&, float way = 0);

    std::vector<FlightEvent*> events;

private:
    std::vector<Flight> list_;
    const GuideRays& guide_;
    PhotonStage& photons_;
    RayStore& store_;
};

} // namespace alpenglow::transport

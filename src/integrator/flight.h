// The stage between hit and shader: what happens to rays on their way, before what they met is shaded.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::transport {

/// The way of a ray to what it met, or out of the scene.
struct Flight {
    const PathRay* ray = nullptr;
    TargetId target = shading::kNoTarget; ///< gets what comes back along the ray
    float length = 0;                     ///< of the way from PathRay::origin; PathRay::maxDistance where it met nothing
    const ShadePoint* point = nullptr;    ///< that it met; null: nothing
    int binding = -1;                     ///< of the surface there; -1: none
    Color left{1};                        ///< what events leave of the light of what it met; nothing where it met nothing
    bool over = false;                    ///< an event has ended it: what it met is not shaded and gives it no light
};

/// What can happen on the way: scattering in a medium, by a distance that is drawn; a walk inside of the surface that was met,
/// which comes out elsewhere. An event that ends a flight pays for what it takes: a ray that goes on instead is sent by
/// Flights::divert(), light goes to the flight's target by Accumulator::deposit(). A flight tells what it needs of others: events
/// see one flight at a time, draw by RayStore::random() of its ray, its vertex and kFlight, and so change no bit of whoever
/// shares the batch.
class FlightEvent {
public:
    virtual ~FlightEvent() = default;
    /// Flights of rays that met shapes of one group, or nothing. Those that are over by another event stay as they are.
    virtual void happen(std::span<Flight>, Sched&) = 0;
    /// Takes from shadow rays what the same event would keep from arriving. `out`: by ray, what surfaces and media have left.
    virtual void dim(std::span<const ShadowRay>, std::span<Color> out) = 0;
};

} // namespace alpenglow::transport

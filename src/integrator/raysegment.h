// Events between two surfaces: what happens to a ray before its hit is shaded.
#pragma once
#include "integrator/rays.h"

namespace alpenglow::integrator {

/// A ray segment: from its origin to its hit, or out of the scene.
struct RaySegment {
    const PathRay* ray = nullptr;
    AccumulatorId target = shading::kNoAccumulator; ///< receives the light that comes back along the ray
    float length = 0;                               ///< from PathRay::origin; PathRay::maxDistance without a hit
    const ShadePoint* point = nullptr;              ///< the hit; null: none
    int binding = -1;                               ///< of the surface that was hit; -1: none
    Color transmittance{1};                         ///< factor that events apply to light of the hit; ignored without a hit
    bool over = false;                              ///< an event ended the segment: its hit is not shaded and gives it no light
};

/// An event between two surfaces, such as scattering in a medium at a sampled distance, or a subsurface walk that exits
/// elsewhere. An event that ends a segment is responsible for the light: it sends continuing rays with SegmentEvents::spawn() and
/// adds light to the segment's target with Accumulator::contribute(). Segments are independent: an event looks at one at a time
/// and draws random numbers by RayStore::random() of its ray, its vertex and kSegmentEvent, so the other members of the batch
/// change no bit.
class SegmentEvent {
public:
    virtual ~SegmentEvent() = default;
    /// Handles segments that hit shapes of one group, or nothing. Leaves those unchanged that another event has ended.
    virtual void happen(std::span<RaySegment>, Sched&) = 0;
    /// Attenuates shadow rays by the same event. `out`, by ray: transmittance so far, multiplied in place.
    virtual void dim(std::span<const ShadowRay>, std::span<Color> out) = 0;
};

} // namespace alpenglow::integrator

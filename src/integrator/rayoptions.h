// Parameters of trace() for its ray at one point, as a kernel gives them in rows of arguments.
#pragma once
#include "shading/point.h"
#include "world/sites.h"
#include <algorithm>

namespace alpenglow::integrator {

/// Parameters of one trace().
struct RayOptions {
    float bias = -1;           ///< distance of the origin from the point, current space; < 0: by the error bound of the hit
    float maxDistance = 1e38f; ///< "maxdist" and "maxhitdist", current space
    float importance = 1;      ///< factor of PathRay::importance, "weight"; 0: no ray is sent
    int samples = 1;           ///< rays, if all lobes are followed
    shading::Fade fade;        ///< "falloff"
    bool ownOrigin = false;    ///< the ray starts at `from`, so the lobe samples no lights
    Vec3 from;                 ///< camera space
    float base = 0;            ///< "samplebase": rays start within this part of the footprint
};

/// Reads what does not depend on the point itself: all but samples, elsewhere and from. f(row): a number of the call's arguments.
template <class Row> RayOptions rayOptionsOf(const world::SiteInfo& s, const Row& f) {
    const auto number = [&](int row, float otherwise) { return row < 0 ? otherwise : f(row); };
    RayOptions o;
    o.bias = number(s.rays->bias, -1);
    o.maxDistance = std::min(number(s.rays->maxDistance, 1e38f), number(s.rays->maxHit, 1e38f));
    if (o.maxDistance < 0) o.maxDistance = 1e38f; // PRMan: no limit
    if (const int w = s.trace->weight; w >= 0) o.importance = std::max(0.f, maxComponent(Color(f(w), f(w + 1), f(w + 2))));
    if (const auto& fade = s.trace->fade; fade.strength >= 0)
        o.fade = {std::max(0.f, f(fade.strength)), o.maxDistance, number(fade.mode, 0) != 0};
    return o;
}

/// The number of rays that a call asks for, for OcclusionCalls::samplesOf().
template <class Row> float samplesAskedOf(const world::SiteInfo& s, const Row& f) {
    const int row = s.rays->samples;
    if (s.trace->hemisphere) return row < 0 ? 0 : f(row);
    return std::max(1.f, row < 0 ? 1 : f(row));
}

} // namespace alpenglow::integrator

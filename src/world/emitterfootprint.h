// How wide a light sample sees an emitter: as wide as the ray of a lobe that meets it, so that both estimate the same light.
#pragma once
#include "lobes/lobe.h"
#include "world/impl.h"

namespace alpenglow::transport {

/// The half angle in radians that the rays of a lobe widen by: half of the lobe's own, never below that of the ray before.
inline float spreadBehind(const shading::PathRay& ray, float lobeSpread) {
    return std::max(ray.footprint.spread, lobeSpread * 0.5f);
}

/// Whether a kernel of the light reads du or dv: those of its points matter.
inline bool usesFootprint(const BoundLight& l) {
    if (l.kernel.plan && l.kernel.plan->usesFootprint()) return true;
    for (const auto& [strings, k] : l.variants)
        if (k.plan->usesFootprint()) return true;
    return false;
}

/// Fills du and dv of a point of an emitter, whose surface is known, as a ray would have them that starts at `from` and grows by
/// `spread` per unit of length (spreadBehind()). `ray`: the one that found `from`.
inline void setEmitterFootprint(shading::ShadePoint& p, const shading::PathRay& ray, const Vec3& from, float spread) {
    const Vec3 way = meetsAt(p.surface) - from;
    const float distance = length(way);
    const shading::Footprint footprint{ray.footprint.at(length(from - ray.origin)), spread};
    shading::setFootprint(p, footprint, distance > 0 ? way / distance : ray.dir, distance, 1);
}

} // namespace alpenglow::transport

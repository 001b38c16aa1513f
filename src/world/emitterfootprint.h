// Footprint of a light sample on an emitter: equal to that of a lobe's ray that hits it, so that both estimate the same light.
#pragma once
#include "bsdf/lobe.h"
#include "world/impl.h"

namespace alpenglow::world {

/// Half angle in radians by which rays of a lobe widen: half of the lobe's spread, at least that of the incoming ray.
inline float spreadBehind(const shading::PathRay& ray, float lobeSpread) {
    return std::max(ray.footprint.spread, lobeSpread * 0.5f);
}

/// Whether a kernel of the light reads du or dv.
inline bool usesFootprint(const BoundLight& l) {
    if (l.kernel.plan && l.kernel.plan->usesFootprint()) return true;
    for (const auto& [strings, k] : l.variants)
        if (k.plan->usesFootprint()) return true;
    return false;
}

/// Whether the light of an emitter depends on the size of its footprint.
inline bool isWide(const BoundLight& l) { return l.kind == LightKind::Area && usesFootprint(l); }

/// Sets du and dv of a point on an emitter, whose surface is known, for a ray from `from` that widens by `spread` per unit of
/// length (spreadBehind()). `ray`: the ray that found `from`.
inline void setEmitterFootprint(shading::ShadePoint& p, const shading::PathRay& ray, const Vec3& from, float spread) {
    const Vec3 way = intersectsAt(p.surface) - from;
    const float distance = length(way);
    const shading::Footprint footprint{ray.footprint.at(length(from - ray.origin)), spread};
    shading::setFootprint(p, footprint, distance > 0 ? way / distance : ray.dir, distance, 1);
}

} // namespace alpenglow::world

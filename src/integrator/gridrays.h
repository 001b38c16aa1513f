// Camera rays with a given hit: a point of a micropolygon, or of a grid that is baked.
#pragma once
#include "integrator/names.h"
#include "shading/gridpoint.h"
#include "shading/point.h"

namespace alpenglow::integrator {

/// Whether the hit of this ray is given by its sample, regardless of other geometry.
inline bool beginsAtGrid(const shading::PathRay& r) { return r.sample->grid && r.camera() && r.bounces == 0 && r.layers == 0; }

/// du and dv at a hit: those of the given point, else the footprint of the ray there at a shading rate.
inline Vec2 stepsAt(const shading::PathRay& r, const geometry::SurfacePoint& p, float shadingRate) {
    if (beginsAtGrid(r) && r.sample->grid->du > 0) return {r.sample->grid->du, r.sample->grid->dv};
    return shading::footprintAt(p, r.footprint, r.dir, length(p.P - r.origin), shadingRate);
}

} // namespace alpenglow::integrator

// Camera rays whose point is given: of a micropolygon, or of a grid that is baked.
#pragma once
#include "shading/gridpoint.h"
#include "shading/point.h"

namespace alpenglow::transport {

/// Whether a ray meets the point that its sample gives, whatever is there.
inline bool beginsAtGrid(const shading::PathRay& r) { return r.sample->grid && r.camera() && r.bounces == 0 && r.layers == 0; }

/// du and dv at what a ray met: those of the point that its sample gives, else its footprint there at a shading rate.
inline Vec2 stepsAt(const shading::PathRay& r, const geometry::SurfacePoint& p, float shadingRate) {
    if (beginsAtGrid(r) && r.sample->grid->du > 0) return {r.sample->grid->du, r.sample->grid->dv};
    return shading::footprintAt(p, r.footprint, r.dir, length(p.P - r.origin), shadingRate);
}

} // namespace alpenglow::transport

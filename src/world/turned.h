// Walls of holes in CSG solids: the subtracted shape is displaced with its own normals, and shaded with those of the solid, which
// point into the hole.
#pragma once
#include "scene/solids.h"
#include "shading/point.h"
#include "world/names.h"

namespace alpenglow::world {

/// Whether the displacement shader must see the opposite of the shape's normals.
inline bool turnedOver(const geometry::Shape& s) { return scene::solidTakenAway(s.attributes()); }

/// Converts normals of the solid to those of the shape, or back. Normals given by the primitive serve for both.
inline void turnOver(shading::ShadePoint& p) {
    geometry::SurfacePoint& s = p.surface;
    s.n = -s.n;
    s.Ng = -s.Ng;
    s.orientation = -s.orientation;
    if (p.shape->givesNormals()) return;
    for (Vec3* v : {&p.N, &s.N, &s.dNdu, &s.dNdv}) *v = -*v;
}

} // namespace alpenglow::world

// The walls of holes in solids: what is taken away is displaced as it would be alone, with its own normals, and shaded with
// those of the whole, which look into the hole.
#pragma once
#include "scene/solids.h"
#include "shading/point.h"

namespace alpenglow::transport {

/// Whether the shape's normals are the opposite of those that its displacement shader is to see.
inline bool turnedOver(const geometry::Shape& s) { return scene::solidTakenAway(s.attributes()); }

/// From the normals of the whole to those of the shape alone, or back. Normals that the primitive gives are both.
inline void turnOver(shading::ShadePoint& p) {
    geometry::SurfacePoint& s = p.surface;
    s.n = -s.n;
    s.Ng = -s.Ng;
    s.orientation = -s.orientation;
    if (p.shape->givesNormals()) return;
    for (Vec3* v : {&p.N, &s.N, &s.dNdu, &s.dNdv}) *v = -*v;
}

} // namespace alpenglow::transport

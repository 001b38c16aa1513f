// Grids of micropolygons over whole primitives, for what shaders bake: rays meet points, and baking wants all of a surface.
#pragma once
#include "geometry/dice.h"
#include "shading/gridpoint.h"
#include <vector>

namespace alpenglow::shading {

/// Whether a primitive has a grid: quadrics, and all that rays meet as triangles. Not curves, points and what has its own way to
/// be met.
bool hasGrid(const geometry::Shape&);

/// The corners of micropolygons whose edges are about sqrt(ShadingRate) pixels long, each once, and the middles of them where
/// `middles` says so. Quadrics have rows over u and v, whose first and last meet where the surface closes; the others are cut
/// from the triangles that rays meet. Coarser where there would be more than limits::kDiceQuads. GridPoint::shape stays 0; P:
/// where they are, camera space, as the shutter opens.
void gridOf(const geometry::Shape&, const geometry::DiceCamera&, bool middles, std::vector<GridPoint>& points,
            std::vector<Vec3>& P);

} // namespace alpenglow::shading

// Grids of micropolygons over complete primitives for baking, which needs all of a surface rather than ray hits.
#pragma once
#include "geometry/dice.h"
#include "shading/gridpoint.h"
#include <vector>

namespace alpenglow::shading {

/// Whether a primitive has a grid: quadrics, and shapes intersected as triangles. Not curves, points and shapes with their own
/// intersection.
bool hasGrid(const geometry::Shape&);

/// The corners of micropolygons with edges of about sqrt(ShadingRate) pixels, each once, and with `middles` also the centres.
/// Quadrics have rows over u and v, whose first and last coincide on closed surfaces; other shapes are cut from their triangles.
/// Coarser if there were more than limits::kDiceQuads. GridPoint::shape stays 0; P: positions at shutter open, camera space.
void gridOf(const geometry::Shape&, const geometry::DiceCamera&, bool middles, std::vector<GridPoint>& points,
            std::vector<Vec3>& P);

} // namespace alpenglow::shading

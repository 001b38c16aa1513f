// Baking: grid points of primitives whose shaders bake, and the files that result.
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/bakelog.h"
#include "shading/gridpoint.h"
#include "world/world.h"
#include <span>
#include <vector>

namespace alpenglow::world {

/// Whether a shader of the frame bakes.
bool bakes(const World&);
/// Numbers of the shapes that have a grid and whose surface shaders bake.
std::vector<uint32_t> bakedShapes(const World&);
/// Whether either all points of this shape bake or none, i.e. the conditions around the baking calls are uniform. For lights: all
/// points at which they run.
bool bakesAllOrNone(const World&, uint32_t shape);
/// Whether every light that could bake at the shape has run. runs: integrator::Counters::lightRuns, of the rays in question
/// alone.
bool bakingLightsRan(const World&, uint32_t shape, std::span<const uint64_t> runs);
/// Appends the grid points of a shape in order, without points of CSG solids that are not on the boundary.
void bakedPoints(const World&, uint32_t shape, std::vector<shading::GridPoint>&);
/// Where a grid point lies, camera space; on a displaced surface after displacement.
Vec3 placeOf(const World&, const shading::GridPoint&);
/// Whether anything was baked since the last call. Call while no thread traces.
bool bakedNow(const World&);
/// Appends what was baked since the last call to the earlier records (keep), or discards it. Call while no thread traces.
void commitBakes(const World&, bool keep);
/// Writes the baked files, except those that `others` own. Returns false after an error, which is reported.
bool writeBakes(const World&, bool allowWrite, const pointcloud::FileOwners& others, Diagnostics&);

} // namespace alpenglow::world

// Baking: rays to the grid points of primitives whose shaders bake, and the files that result.
#pragma once
#include "base/diagnostics.h"
#include "integrator/samples.h"
#include "pointcloud/bakelog.h"
#include "shading/gridpoint.h"
#include "world/world.h"
#include <vector>

namespace alpenglow::integrator {

/// Whether a shader of the frame bakes.
bool bakes(const World&);
/// Numbers of the shapes that have a grid and whose surface shaders bake.
std::vector<uint32_t> bakedShapes(const World&);
/// Whether either all points of this shape bake or none, i.e. the conditions around the baking calls are uniform. For lights: all
/// points at which they run.
bool bakesAllOrNone(const World&, uint32_t shape);
/// Starts to record which lights run. Call while no thread traces.
void noteLightsOfBakes(const World&);
/// Stops recording. Returns whether every light that could bake at the shape has run. Call while no thread traces.
bool bakingLightsRan(const World&, uint32_t shape);
/// Appends the grid points of a shape in order, without points of CSG solids that are not on the boundary.
void bakedPoints(const World&, uint32_t shape, std::vector<shading::GridPoint>&);
/// A ray from the eye to a grid point that ignores all geometry before it. number: index of the point within its shape. `pixel`:
/// a camera ray that supplies footprint and time. The point must outlive the trace, which sets its distance.
CameraRay rayTo(const World&, shading::GridPoint&, int number, const CameraRay& pixel);
/// Whether anything was baked since the last call. Call while no thread traces.
bool bakedNow(const World&);
/// Appends what was baked since the last call to the earlier records (keep), or discards it. Call while no thread traces.
void commitBakes(const World&, bool keep);
/// Writes the baked files, except those that `others` own. Returns false after an error, which is reported.
bool writeBakes(const World&, bool allowWrite, const pointcloud::FileOwners& others, Diagnostics&);

} // namespace alpenglow::integrator

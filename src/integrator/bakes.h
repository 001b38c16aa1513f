// Baking: the points of grids over primitives whose shaders bake, as rays that find them, and the files that come of it.
#pragma once
#include "base/diagnostics.h"
#include "clouds/bakelog.h"
#include "integrator/samples.h"
#include "shading/gridpoint.h"
#include "world/world.h"
#include <vector>

namespace alpenglow::transport {

/// Whether some shader of the frame bakes.
bool bakes(const World&);
/// The shapes with a grid whose surface shaders bake, by number.
std::vector<uint32_t> bakedShapes(const World&);
/// Whether all points of such a shape bake, or none of them: where conditions on the way to the calls do not vary over it. Of
/// lights, those points at which they are run.
bool bakesAllOrNone(const World&, uint32_t shape);
/// Begins to note which lights are run. Nobody traces meanwhile.
void noteLightsOfBakes(const World&);
/// Ends that. Whether all lights of a shape that could bake there were run. Nobody traces meanwhile.
bool bakingLightsRan(const World&, uint32_t shape);
/// Adds the points of a shape's grid, in their order. Points of solids that bound nothing are left out.
void bakedPoints(const World&, uint32_t shape, std::vector<shading::GridPoint>&);
/// A ray from the eye that finds a point, whatever is before it; number: among those of its shape. `pixel`: a ray of the camera,
/// whose footprint and time it gets. The point outlives the ray's trace, and gets its distance.
CameraRay rayTo(const World&, shading::GridPoint&, int number, const CameraRay& pixel);
/// Whether anything was baked since the last time. Nobody traces meanwhile.
bool bakedNow(const World&);
/// What was baked since the last time goes behind what was baked before, or is forgotten. Nobody traces meanwhile.
void settleBakes(const World&, bool keep);
/// Writes what was baked, but over no file of the others. False: an error was reported.
bool writeBakes(const World&, bool allowWrite, const clouds::FileOwners& others, Diagnostics&);

} // namespace alpenglow::transport

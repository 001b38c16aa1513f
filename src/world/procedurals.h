// Deferred procedurals, which are expanded when a ray reaches their bound (scene/deferred.h): interface of a world.
#pragma once
#include "world/names.h"
#include "world/world.h"
#include <vector>

namespace alpenglow::world {

/// Numbers of the procedurals that rays reached. Results of these rays are undefined; trace them again in a world that has the
/// contents.
std::vector<int> procedurals(const World&);
/// Whether deferred procedurals are left.
bool hasDeferred(const World&);
/// Whether the world needs all of its shapes: for baking, photon maps, irradiance caching.
bool needsAllShapes(const World&);
/// Takes over constant results of shaders from the previous world. Call while no thread traces.
void takeOver(const World&, const World& before);
/// Whether shaders have printed output that is not yet written.
bool hasPrints(const World&);

} // namespace alpenglow::world

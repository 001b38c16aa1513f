// Procedurals whose content is made once a ray comes to their bound (scene/unmade.h): what a world knows of them.
#pragma once
#include "world/world.h"
#include <vector>

namespace alpenglow::transport {

/// How many bounds on its way a ray asks for, at most (1 before this call). Before anything is traced.
void askForProcedurals(const World&, int most);
/// Numbers of those that rays came to: what such rays brought is void, and to be traced again in a world that has their content.
std::vector<int> procedurals(const World&);
/// Whether some are left that are not made.
bool hasUnmade(const World&);
/// Whether work is to be done on this world that needs all of its shapes: baking, photon maps, light that is interpolated.
bool needsAllShapes(const World&);
/// Takes over from the world before it what shaders have said once and for all. Nobody traces meanwhile.
void takeOver(const World&, const World& before);
/// Whether shaders have printed what is not written yet.
bool hasPrints(const World&);

} // namespace alpenglow::transport

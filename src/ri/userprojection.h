// Projections by a matrix of the user's (RISpec 3.2, RiProjection with a null name): the transformations in front of WorldBegin
// lead to the screen, perspective included.
#pragma once
#include "scene/fwd.h"
#include "scene/param.h"

namespace alpenglow::ri {

/// Where worldToCamera holds a perspective and the projection is orthographic: takes the perspective out of it and into the
/// options, as "perspective" with a field of view and a screen window. What is left leads to a camera space of the world's units.
/// False: nothing to do.
bool takeProjection(scene::Transform& worldToCamera, scene::Options&);

} // namespace alpenglow::ri

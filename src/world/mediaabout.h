// The volumes around a point.
#pragma once
#include "world/impl.h"

namespace alpenglow::world {

/// The Interior volumes that contain a point of current space at shutter position `time` (0 to 1). Requires the acceleration
/// structure.
shading::Media mediaAbout(const WorldImpl&, const Vec3& at, float time);

} // namespace alpenglow::world

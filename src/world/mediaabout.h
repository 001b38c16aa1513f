// Which volumes are about a point.
#pragma once
#include "world/impl.h"

namespace alpenglow::transport {

/// The volumes of Interior that a point of current space lies in, when the shutter stands at `time` (0 to 1); once rays can be
/// sent.
shading::Media mediaAbout(const WorldImpl&, const Vec3& at, float time);

} // namespace alpenglow::transport

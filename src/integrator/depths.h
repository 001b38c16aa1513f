// Pictures of depth alone.
#pragma once
#include "world/world.h"

namespace alpenglow::transport {

/// Whether rays with CameraRay::depthOnly tell the depth of what camera rays meet first as those of a picture do, to the bit, and
/// nobody misses the shaders: every surface is opaque for shadow rays, no volume stands about the eye, no clipping plane and no
/// procedural that is made when rays come to it, and no shader prints or bakes.
bool depthsNeedNoShaders(const World&);

} // namespace alpenglow::transport

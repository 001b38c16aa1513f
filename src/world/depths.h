// Pictures of depth alone.
#pragma once
#include "world/names.h"
#include "world/world.h"

namespace alpenglow::world {

/// Whether rays with CameraRay::depthOnly give the depth of the first hit with the same bits as a complete picture, so that no
/// shader needs to run. Requires: all surfaces are opaque to shadow rays; no volume around the eye; no clipping plane; no
/// deferred procedural; no shader that prints or bakes.
bool depthsNeedNoShaders(const World&);

} // namespace alpenglow::world

// Baking by shaders, before the picture.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Shades every primitive that has a grid and whose surface shader bakes, with `samples` samples a point, into the world's log.
/// Returns false if stopped; the log is then incomplete.
bool bakeGrids(Job&, uint32_t samples);

} // namespace alpenglow::render

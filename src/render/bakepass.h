// What shaders bake, before the picture.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Shades every primitive with a grid whose surface shader bakes, `samples` times a point. The world's log has what was baked
/// then. False: it was stopped, and what was not reached is missing.
bool bakeGrids(Job&, uint32_t samples);

} // namespace alpenglow::render

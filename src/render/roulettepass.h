// How roulette ends the paths of a frame, learned from a few of them before the first sample (docs/noise.md). Internal to
// render/.
#pragma once
#include "render/rendering.h"

namespace alpenglow::render {

/// Chooses the roulette of the frame's paths by paths that are no samples of the picture. Equal for all parts, samples and
/// threads of a picture. Small pictures keep the usual one. Returns false if stopped.
bool learnRoulette(Job&);

} // namespace alpenglow::render

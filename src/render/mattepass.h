// Cryptomatte: which objects, by the names of an attribute or of materials, cover the pixels of a picture.
#pragma once
#include "display/matte.h"
#include "render/rendering.h"

namespace alpenglow::render {

/// The mattes of the picture's window, one for each layer. A pixel's coverage by a name is the sum of the filter's weights at the
/// image samples (nx x ny in a pixel), each times what the surfaces of that name hide there of what is behind them (the mean over
/// the colours), over the sum of all weights. Lens, shutter and opacity count as in the picture; media hide and have no name.
/// Null if stopped.
display::MattesRef seeMattes(Job&, const MattesAsked&, const PixelFilter&, int nx, int ny, Jitter, uint64_t seed);

} // namespace alpenglow::render

// How the numbers of 8-bit maps are read (docs/colour.md).
#pragma once
#include "base/diagnostics.h"
#include "scene/fwd.h"
#include "scene/primitive.h"

namespace alpenglow::scene {

/// What colours in maps of 8 bits are. AsTheyAre: what the file holds, whatever it declares. Light and Srgb: what the file
/// declares, else light, or sRGB.
enum class MapColours { AsTheyAre, Light, Srgb };

/// Option "texture" "colorspace" "linear" or "srgb"; else, and by "auto", Srgb under path and AsTheyAre under hidden and
/// raytrace. Another word is reported.
MapColours mapColours(const Options&, bool path, Diagnostics&);

} // namespace alpenglow::scene

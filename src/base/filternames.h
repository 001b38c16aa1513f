// Names of filters of pixels and textures, as renderers and their exporters spell them.
#pragma once
#include <string>
#include <string_view>

namespace alpenglow {

/// The name that RISpec or PRMan gives a filter: "catmull-rom" of "catmullrom", "CatmullRom" and "RiCatmullRomFilter", "triangle"
/// of "tent". A name of no filter comes back as it is.
std::string filterNameOf(std::string_view spelled);

} // namespace alpenglow

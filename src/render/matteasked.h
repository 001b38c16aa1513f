// What the display of a type "cryptomatte" asks for (mattepass.h).
#pragma once
#include "scene/param.h"
#include <string>
#include <vector>

namespace alpenglow::render {

/// Parameters of one display.
struct MattesAsked {
    std::vector<std::string> layers; ///< attributes "class:name", or "material"
    int ranks = 6;                   ///< 2 to limits::kMatteRanks, even
};
/// By the parameters "layer" and "levels" of a Display; bad ones are reported, as are more channels than a picture can have
/// (limits::kImageChannels). channels: those of the picture beside the mattes.
MattesAsked mattesAsked(const scene::ParamList&, size_t channels, const SourcePlace&, Diagnostics&);

} // namespace alpenglow::render

// MakeTexture, MakeBump, MakeLatLongEnvironment, MakeShadow: pictures to maps, as tiled MIP-mapped OpenEXR files whatever their
// extension. The cache reads their levels as they are. Source: ri.md 11.
#pragma once
#include "base/file.h"
#include "texture/texture.h"

namespace alpenglow::texture {

struct MakeOptions {
    std::string swrap = "black", twrap = "black"; ///< RISpec's default; lat-long maps: periodic, clamp
    std::string filter = "box";                   ///< of the reduction; widths multiply the filter's own (pyramid.h)
    float swidth = 1, twidth = 1;
    std::vector<std::string> searchPath{""};      ///< of the picture
    OutputPolicy policy;
    SourcePlace place;
};

/// False: an error was reported and an older map of that name is intact. Unknown wrap modes and filters, and widths that are not
/// positive, are reported and replaced by the defaults.
bool makeTexture(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
bool makeLatLongEnvironment(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
/// A depth picture (zfile, or with a "z" channel, else its first) to a shadow map; the matrices are kept. Without them the map is
/// written, with a warning that shadow() cannot place it.
bool makeShadow(const std::string& zfile, const std::string& shadow, const MakeOptions&, Diagnostics&);

} // namespace alpenglow::texture

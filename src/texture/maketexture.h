// MakeTexture, MakeBump, MakeLatLongEnvironment, MakeShadow: pictures to maps, as tiled MIP-mapped OpenEXR files whatever their
// extension. The cache reads their levels as they are. RISpec 3.2, 7.1.
#pragma once
#include "base/file.h"
#include "texture/texture.h"

namespace alpenglow::texture {

struct MakeOptions {
    std::string swrap = "black", twrap = "black"; ///< RISpec's default; lat-long maps: periodic, clamp
    std::string filter = "box";                   ///< of the reduction; widths multiply the filter's own (pyramid.h)
    float swidth = 1, twidth = 1;
    /// What the numbers of pictures are, whatever they declare. Srgb: the map is made of their light. Auto: what they declare is
    /// kept, and that they had 8 bits; so the map is read as its picture would be.
    enum class Colours { Auto, Light, Srgb } colours = Colours::Auto;
    std::vector<std::string> searchPath{""}; ///< of the picture
    OutputPolicy policy;
    ReadPolicy read{}; ///< where the names of pictures may lead
    SourcePlace place;
};

/// Pictures may be files of bake() (clouds/bakefile.h), also "name&binary".
/// False: an error was reported and an older map of that name is intact. Unknown wrap modes and filters, and widths that are not
/// positive, are reported and replaced by the defaults.
bool makeTexture(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
bool makeLatLongEnvironment(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
/// Six pictures of the same size, in the order px nx py ny pz nz (texture.h cubeFace has their orientation), each seen with a
/// field of view of fov degrees. Their reduced levels are made when the map is loaded.
bool makeCubeFaceEnvironment(const std::vector<std::string>& pictures, const std::string& texture, float fov, const MakeOptions&,
                             Diagnostics&);
/// A depth picture (zfile, or with a "z" channel, else its first) to a shadow map; the matrices are kept. Without them the map is
/// written, with a warning that shadow() cannot place it.
bool makeShadow(const std::string& zfile, const std::string& shadow, const MakeOptions&, Diagnostics&);

/// Point clouds as one brick map (clouds/brickmap.h).
bool makeBrickMap(const std::vector<std::string>& clouds, const std::string& bricks, const MakeOptions&, Diagnostics&);

/// A request of RIB by its name: strings and numbers in the order of its arguments (MakeTexture: picture texture swrap twrap
/// filter; swidth twidth). Where it has wrap modes, filter and widths they replace those of the options. Requests that are not
/// done here (MakeOcclusion) are reported. False: an error was reported.
bool runMakeRequest(const std::string& request, const std::vector<std::string>& strings, const std::vector<float>& numbers,
                    const MakeOptions&, Diagnostics&);

} // namespace alpenglow::texture

// MakeTexture, MakeBump, MakeLatLongEnvironment, MakeShadow: convert pictures to maps, as tiled MIP-mapped OpenEXR files with any
// extension. The cache reads their levels directly. RISpec 3.2, 7.1.
#pragma once
#include "base/file.h"
#include "texture/texture.h"

namespace alpenglow::texture {

/// What the requests and maketx set.
struct MakeOptions {
    std::string swrap = "black", twrap = "black"; ///< RISpec's default; lat-long maps: periodic, clamp
    std::string filter = "box";                   ///< of the reduction; widths multiply the filter's own (pyramid.h)
    float swidth = 1, twidth = 1;                 ///< times the width of the filter
    /// Interpretation of pictures, regardless of what they declare. Srgb: converts to linear light. Auto: keeps the declaration,
    /// and whether they had 8 bits, so that the map is read like the picture.
    enum class Colours { Auto, Light, Srgb } colours = Colours::Auto;
    std::vector<std::string> searchPath{""}; ///< of the picture
    OutputPolicy policy;                     ///< where the map may be written
    ReadPolicy read{};                       ///< where the names of pictures may lead
    SourcePlace place;                       ///< of the request, for messages
};

/// Pictures may be files of bake() (pointcloud/bakefile.h), also "name&binary". Returns false after an error, which is reported;
/// an older map of that name is then intact. Unknown wrap modes and filters, and widths that are not positive, are reported and
/// replaced by the defaults.
bool makeTexture(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
/// The same for MakeLatLongEnvironment: longitude along the width, latitude along the height.
bool makeLatLongEnvironment(const std::string& picture, const std::string& texture, const MakeOptions&, Diagnostics&);
/// Six pictures of the same size, in order px nx py ny pz nz (orientation: texture.h cubeFace), each with a field of view of fov
/// degrees. Reduced levels are made when the map is loaded.
bool makeCubeFaceEnvironment(const std::vector<std::string>& pictures, const std::string& texture, float fov, const MakeOptions&,
                             Diagnostics&);
/// Converts a depth picture (zfile, or its "z" channel, else its first) to a shadow map with its matrices. Without matrices the
/// map is written, with a warning that shadow() cannot use it.
bool makeShadow(const std::string& zfile, const std::string& shadow, const MakeOptions&, Diagnostics&);

/// Point clouds as one brick map (pointcloud/brickmap.h).
bool makeBrickMap(const std::vector<std::string>& clouds, const std::string& bricks, const MakeOptions&, Diagnostics&);

/// Runs a RIB request by name: strings and numbers in order of its arguments (MakeTexture: picture texture swrap twrap filter;
/// swidth twidth). Its wrap modes, filter and widths replace those of the options. Reports unsupported requests (MakeOcclusion).
/// Returns false after an error, which is reported.
bool runMakeRequest(const std::string& request, const std::vector<std::string>& strings, const std::vector<float>& numbers,
                    const MakeOptions&, Diagnostics&);

} // namespace alpenglow::texture

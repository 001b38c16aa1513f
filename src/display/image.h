// A picture in memory, shared by codecs, drivers and textures.
#pragma once
#include "base/matrix.h"
#include "display/deep.h"
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace alpenglow::display {

/// Interleaved float pixels, row by row from the top, unconverted from file or film (any colour space; alpha unchanged). Channel
/// names: "r" "g" "b" "a" "z" "y" (luminance), or "layer.r", "N.x", a plain name for float AOVs.
struct Image {
    int width = 0, height = 0;         ///< in pixels
    std::vector<std::string> channels; ///< names, in the order of the numbers of a pixel
    std::vector<float> data;           ///< width * height * channels.size()
    /// Text attributes. Known keys: "wrapmodes" ("periodic,clamp": s then t), "textureformat" ("Plain Texture",
    /// "LatLong Environment", "Shadow"), "gamma" (file value = linear ^ gamma, declared by the file), "colorspace" ("sRGB").
    std::map<std::string, std::string> metadata;
    /// Row vectors (base/matrix.h). NDC: (0,0) upper left, (1,1) lower right, as OpenEXR's attribute and RI's "NDC" space have
    /// it.
    std::optional<Matrix> worldToCamera, worldToNDC;
    int originX = 0, originY = 0;      ///< of the first pixel in the full picture (crop window)
    int fullWidth = 0, fullHeight = 0; ///< of the full picture; 0 = not cropped
    float pixelAspect = 1;             ///< width divided by height of a pixel
    int bits = 32;                     ///< per channel in the source file
    bool floating = true;              ///< that file held floating point
    /// For a deep shadow map: layers behind the first surfaces, which `data` holds as "z". Null: a flat picture.
    std::shared_ptr<const DeepSamples> deep;
    std::vector<Image> levels; ///< reduced MIP-map levels 1, 2, ... if the file has them and they were requested

    /// Numbers of a pixel.
    int channelCount() const { return int(channels.size()); }
    /// Numbers of all pixels.
    size_t sampleCount() const { return size_t(width) * size_t(height) * channels.size(); }
    /// The channels of a pixel; row 0 is the upper one. No check of the range.
    float* pixel(int x, int y) { return data.data() + (size_t(y) * size_t(width) + size_t(x)) * channels.size(); }
    const float* pixel(int x, int y) const { return data.data() + (size_t(y) * size_t(width) + size_t(x)) * channels.size(); }
    /// Index of a channel, or -1.
    int channel(std::string_view name) const;
};

/// From screen space as zfiles, Pixar's TIFF tags and textureinfo() have it (x -1..1 to the right, y 1..-1 downward) to NDC.
Matrix screenToNDC();
/// An image of zeros.
Image makeImage(int width, int height, std::vector<std::string> channels);
/// Names where a format has none: y | y a | r g b | r g b a | r g b a channel4 ...
std::vector<std::string> defaultChannels(int count);
/// The named channels, in that order; names that are not there are left out.
Image selectChannels(const Image&, const std::vector<std::string>& names);

} // namespace alpenglow::display

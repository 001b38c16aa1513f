// A picture in memory: what codecs read and write, drivers fill and textures are built from.
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

/// Pixels are floats, interleaved, row by row from the top, as the file or the film gave them (no colour space is implied; alpha
/// stays as it was). Channel names: "r" "g" "b" "a" "z" "y" (luminance), or "layer.r", "N.x", a bare name for float AOVs.
struct Image {
    int width = 0, height = 0;
    std::vector<std::string> channels;
    std::vector<float> data; ///< width * height * channels.size()
    /// Text attributes. Known keys: "wrapmodes" ("periodic,clamp": s then t), "textureformat" ("Plain Texture",
    /// "LatLong Environment", "Shadow"), "gamma" (file value = linear ^ gamma, declared by the file), "colorspace" ("sRGB").
    std::map<std::string, std::string> metadata;
    /// Row vectors (base/matrix.h). NDC: (0,0) upper left, (1,1) lower right, as OpenEXR's attribute and RI's "NDC" space have
    /// it.
    std::optional<Matrix> worldToCamera, worldToNDC;
    int originX = 0, originY = 0;      ///< of the first pixel in the full picture (crop window)
    int fullWidth = 0, fullHeight = 0; ///< of the full picture; 0 = not cropped
    float pixelAspect = 1;
    int bits = 32;        ///< per channel in the file it came from
    bool floating = true; ///< that file held floating point
    /// Of a deep shadow map: what is behind the first surfaces, which `data` holds as "z". Null: a flat picture.
    std::shared_ptr<const DeepSamples> deep;
    std::vector<Image> levels; ///< reduced MIP-map levels 1, 2, ... when the file has them and they were asked for

    int channelCount() const { return int(channels.size()); }
    size_t sampleCount() const { return size_t(width) * size_t(height) * channels.size(); }
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

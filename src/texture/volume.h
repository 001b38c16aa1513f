// Blocks of voxels: stacks of pictures, results of maketx --gradients, and OpenVDB grids (by a module). texture3d() reads them
// like point clouds. (0, 0, 0) is the upper left corner of the first slice, (1, 1, 1) the lower right one of the last.
#pragma once
#include "base/file.h"
#include "pointcloud/map.h"
#include "texture/maketexture.h"
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alpenglow::texture {

/// A block of voxels in memory.
struct Volume {
    int width = 0, height = 0, depth = 0; ///< voxels
    std::vector<std::string> names;       ///< of channels
    std::vector<float> values;            ///< slice by slice, row by row, interleaved
    /// Numbers of a voxel.
    int channels() const { return int(names.size()); }
    /// The channels of a voxel. No check of the range.
    const float* at(int x, int y, int z) const {
        return &values[((size_t(z) * size_t(height) + size_t(y)) * size_t(width) + size_t(x)) * names.size()];
    }
    float* at(int x, int y, int z) { return const_cast<float*>(std::as_const(*this).at(x, y, z)); }
};

/// "textureformat" of a picture with slices below each other; its "depth" is their number.
extern const char* const volumeFormat;

/// Whether a name refers to a stack of pictures: a number like "%03d" or "####" (slices from the first existing one, 0 or 1,
/// without gaps), a star and number ("a.png*16": a strip of 16 slices, else one picture 16 times), or ".vdb".
bool namesVolume(const std::string& name);

/// Where volumes are looked up, and for whom.
struct VolumeFiles {
    std::vector<std::string> searchPath{""}; ///< folders, in order
    ReadPolicy read{};                       ///< where names may lead
    SourcePlace place;                       ///< of the request or call, for messages
};
/// Loads the slices of a name, or a picture of volumeFormat. Returns nothing after an error, which is reported.
std::optional<Volume> loadVolume(const std::string& name, const VolumeFiles&, Diagnostics&);
/// Whether the picture at a path is of volumeFormat. Reads no more than its head.
bool holdsVolume(const std::string& path);

/// Converts a volume to r, g, b, a: gradients of its opacity as colours, 0.5 (n + 1), and opacity. Opacity: "a", else the mean of
/// the colours. n: normalised central difference over 2 * radius voxels, or 0 if below 1e-4; 0 closer than `radius` to the
/// border. radius: at least 1.
Volume gradientsOf(const Volume&, int radius);
/// Averages the directions in r, g, b over (2 radius + 1)^3 existing voxels; not normalised.
void smoothGradients(Volume&, int radius);
/// `maketx --gradients`: writes a picture of volumeFormat. Returns false after an error, which is reported.
bool makeGradients(const std::string& volume, const std::string& picture, int radius, int smooth, const MakeOptions&,
                   Diagnostics&);

/// For texture3d(): maps the volume to the unit cube. Channels: "color" (r, g, b, or grey), "alpha" (a, else the mean of the
/// colours), "gradient" (vector: 2 r - 1, 2 g - 1, 2 b - 1), and each channel by its name. Interpolated between voxels and
/// levels; empty outside of the cube.
std::shared_ptr<const pointcloud::CloudMap> mapOf(Volume);

} // namespace alpenglow::texture

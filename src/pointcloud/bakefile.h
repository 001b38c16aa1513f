// What bake() writes: values at places of a texture, s and t. As text, "# bake 1 TYPE" and one line a point: s, t and the
// numbers; or, little-endian:
//   bytes 0-7    "ALPGBAKE"
//   8-11         version, 1
//   12-15        channel type (pointcloud.h)
//   16-23        points
//   then points: s, t and the numbers of the value, float
//   last 4       CRC-32 of all before
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/pointcloud.h"
#include <optional>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::pointcloud {

/// The points of one file of bake().
struct Baked {
    ChannelType type = ChannelType::Float; ///< of the value
    std::vector<float> rows;               ///< s, t, then sizeOf(type) numbers, by point
    /// Number of points.
    size_t size() const { return rows.size() / (2 + size_t(sizeOf(type))); }
};

/// The name of a file without "&binary". *binary: whether that was there.
std::string bakeFileName(const std::string& name, bool* binary);
/// Returns false after an error, which is reported; an existing file is then unchanged.
bool saveBaked(const std::string& name, const Baked&, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
/// Whether the first bytes of a file are those of this format.
bool isBaked(const std::string& path);
/// Nothing: an error was reported.
std::optional<Baked> loadBaked(const std::string& path, Diagnostics&, const SourcePlace& = {});

/// A picture of the points with s and t in [0, 1], t downward: about as many pixels as points, each side a power of two. A pixel
/// is the value of the plane that best fits the points within two pixels of its centre (weights (1 - d^2 / 4)^2), so linear
/// functions of s and t are preserved. Gaps are filled from coarser pictures.
struct BakedPicture {
    int side = 0, channels = 0; ///< pixels of a side; numbers of a pixel
    std::vector<float> pixels;  ///< row by row
    size_t outside = 0;         ///< points that are left out
};
/// Of the points of a file.
BakedPicture pictureOf(const Baked&);

} // namespace alpenglow::pointcloud

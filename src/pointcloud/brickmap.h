// Brick maps: point clouds as tiles of an octree with levels, of which a render reads those that it meets (docs/pointclouds.md).
// The finest level has the points of coarser() (pointcloud.h) in the cube about the cloud, each other level those of the one
// below it; a brick has those of 8 x 8 x 8 cells of its level. Little-endian throughout:
//   bytes 0-7    "ALPGBRIC"
//   8-11         version, 1
//   12-15        channels
//   16-19        levels
//   20-31, 32-35 corner and side of the cube, float
//   36-39        bricks
//   40-43        bytes before the first brick, H
//   then the channels as in point clouds (cloudfile.h)
//   then by level the largest radius, float
//   then by brick: level, x, y, z in bricks (uint32 each), points (uint32), place in the file (uint64), CRC-32 of its points;
//   sorted
//                by level, x, y, z
//   H-4 to H-1   CRC-32 of all before
//   then the points of the bricks, as those of point clouds
#pragma once
#include "pointcloud/map.h"
#include <optional>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::pointcloud {

inline constexpr int kDeepest = 16; ///< levels, at most: cells are 2^-15 of the cube

/// The level whose cells are at most half as wide as a filter.
int depthFor(float side, float radius);
/// The cube that levels cut.
void cubeAbout(const PointCloud&, Vec3* corner, float* side);
/// Divides the sums of a lookup by the weight. Returns false if nothing was found.
bool meanOf(double weight, std::span<const double> sums, std::span<float> out);

/// Writes a brick map of a cloud, down to the level with cells as wide as the median disk. Returns false after an error, which is
/// reported.
bool saveBrickMap(const std::string& name, const PointCloud&, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
/// By its first bytes; false: there is no such file.
bool isBrickMap(const std::string& path);
/// The directory of a brick map.
struct BrickFacts {
    std::vector<Channel> channels; ///< in the order of the values
    size_t levels = 0, bricks = 0; ///< bricks: of all levels
    uint64_t points = 0;           ///< of the finest level
    Vec3 corner;                   ///< of the cube about the cloud
    float side = 0;                ///< of that cube, world space
};
/// Returns nothing after an error, which is reported.
std::optional<BrickFacts> brickFacts(const std::string& path, Diagnostics&);
/// Opens a brick map and reads its head. Bricks are read at first use, and the least recently used ones dropped beyond
/// `cacheBytes`. Returns null after an error, which is reported.
std::shared_ptr<const CloudMap> openBrickMap(const std::string& path, Diagnostics&, const SourcePlace& = {},
                                             size_t cacheBytes = size_t(256) << 20);

} // namespace alpenglow::pointcloud

// Shared by makers and reader of brick maps (format: brickmap.h).
#pragma once
#include "pointcloud/brickmap.h"
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

namespace alpenglow::pointcloud {

/// First bytes of a file, and its version.
inline constexpr char kBrickMagic[] = "ALPGBRIC";
inline constexpr uint32_t kBrickVersion = 1;
inline constexpr size_t kBrickFixed = 44, kBrickEnd = 4, kOfBrick = 32; ///< sizes in bytes: header, end mark, directory entry
inline constexpr int kBrickLog = 3;                                     ///< a brick has 2^kBrickLog cells along a side
inline constexpr uint32_t kBrickSide = 1u << kBrickLog;                 ///< cells

using BrickPlace = std::array<uint32_t, 4>; ///< level, x, y, z

/// An entry of the directory: where a brick is in space and in the file.
struct Brick {
    BrickPlace at;       ///< level and cell
    uint32_t points = 0; ///< occupied cells
    uint64_t offset = 0; ///< of its data, from the start of the file
    uint32_t crc = 0;    ///< CRC-32 of its data
};

/// The cell of a coordinate at a level.
inline uint32_t cellOf(double x, float corner, float side, int depth) {
    const uint32_t cells = 1u << depth;
    const double cell = side > 0 ? (x - double(corner)) / double(side) * cells : 0;
    return uint32_t(std::clamp(cell, 0.0, double(cells - 1)));
}
/// The brick that has this cell.
inline uint32_t brickOf(double x, float corner, float side, int depth) { return cellOf(x, corner, side, depth) / kBrickSide; }

/// The level with cells as wide as the median disk.
inline int deepestOf(std::vector<float> radii, float side) {
    if (radii.empty()) return 0;
    std::nth_element(radii.begin(), radii.begin() + long(radii.size() / 2), radii.end());
    const float disk = 2 * radii[radii.size() / 2];
    int depth = 0;
    while (depth < kDeepest - 1 && side > disk) side /= 2, ++depth;
    return depth;
}

/// Points of a level by brick.
inline std::map<BrickPlace, std::vector<uint32_t>> bricksOf(const PointCloud& level, const Vec3& corner, float side, int depth) {
    std::map<BrickPlace, std::vector<uint32_t>> by;
    for (size_t i = 0; i < level.size(); ++i) {
        BrickPlace at{uint32_t(depth), 0, 0, 0};
        for (int k = 0; k < 3; ++k) at[size_t(k) + 1] = brickOf(double(level.P[i][k]), corner[k], side, depth);
        by[at].push_back(uint32_t(i));
    }
    return by;
}

/// All before the bricks, which follow one another; their offsets are not read. `record`: bytes of a point.
std::vector<uint8_t> brickHead(std::span<const Channel>, std::span<const float> largest, const Vec3& corner, float side,
                               std::span<const Brick>, uint64_t record);

} // namespace alpenglow::pointcloud

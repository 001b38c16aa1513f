// Point clouds in files. docs/pointclouds.md describes the format; little-endian throughout:
//   bytes 0-7    "ALPGCLOU"
//   8-11         version, 1
//   12-15        channels
//   16-23        points
//   24-27        bytes before the points, H
//   28-31        bytes of a point, 28 + 4 for each number of the channels
//   then by channel: type (1 byte: 0 float, 1 color, 2 point, 3 vector, 4 normal, 5 matrix), length of its name (1 byte, 1 to
//   255),
//                name
//   H-4 to H-1   CRC-32 of all before
//   then points: P (3 float), N (3 float), radius, the numbers of the channels
//   last 4       CRC-32 of the points
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/pointcloud.h"
#include <optional>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::pointcloud {

/// Writes a cloud; as PLY if the name ends in ".ply". Returns false after an error, which is reported; an existing file is then
/// unchanged.
bool saveCloud(const std::string& name, const PointCloud&, const OutputPolicy&, Diagnostics&, const SourcePlace& = {});
/// Reads either format, by its first bytes. Returns nothing after an error, which is reported.
std::optional<PointCloud> loadCloud(const std::string& path, Diagnostics&, const SourcePlace& = {});

/// The parts of it, for files of other kinds that hold points (brickmap.h).
std::vector<uint8_t> packChannels(std::span<const Channel>);
/// Reads `count` channels and advances *at. Returns "", or an error message.
std::string unpackChannels(std::span<const uint8_t> bytes, uint32_t count, size_t* at, std::vector<Channel>& to);
/// Appends a point in the form that unpackPoint() reads.
void packPoint(const PointCloud&, size_t point, std::vector<uint8_t>& to);
/// Adds a point of 28 + 4 width bytes. Returns false for invalid points.
bool unpackPoint(const uint8_t* from, int width, std::vector<float>& room, PointCloud& to);

// ply.cpp
bool savePly(const std::string& name, const PointCloud&, const OutputPolicy&, Diagnostics&, const SourcePlace&);
/// Reads a PLY file, ASCII or binary in both byte orders. The element "vertex" has x, y, z; optional nx, ny, nz, radius; other
/// properties become channels (docs/pointclouds.md). Returns "", or an error message.
std::string readPly(std::span<const uint8_t> bytes, PointCloud& to);

} // namespace alpenglow::pointcloud

// Point clouds: surface points with baked values (bake3d), in order of writing (3Delight manual, 6.4.6, tables 6.17 and 6.18).
#pragma once
#include "base/vec.h"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::pointcloud {

/// Type of a channel: determines how spaces transform it.
enum class ChannelType : uint8_t { Float = 0, Color = 1, Point = 2, Vector = 3, Normal = 4, Matrix = 5 };
/// "float", "color", ...
const char* nameOf(ChannelType);
/// Numbers of a value.
inline int sizeOf(ChannelType t) { return t == ChannelType::Float ? 1 : t == ChannelType::Matrix ? 16 : 3; }

/// A named value of every point.
struct Channel {
    std::string name;                      ///< as in the file
    ChannelType type = ChannelType::Float; ///< how many floats a value has
    bool operator==(const Channel&) const = default;
};

/// Points in memory, each with a value for every channel.
struct PointCloud {
    std::vector<Channel> channels; ///< in the order of the values of a point
    std::vector<Vec3> P, N;        ///< N: unit, or 0 where a point is a ball and no disk
    std::vector<float> radius;     ///< of the disk or the ball
    std::vector<float> values;     ///< width() a point
    /// Number of points.
    size_t size() const { return P.size(); }
    int width() const; ///< numbers of the channels of one point
    /// Index of a channel's first number; -1: no such channel.
    int offsetOf(const std::string& name) const;
    std::span<const float> valuesOf(size_t point) const { return {values.data() + point * size_t(width()), size_t(width())}; }
    /// Makes room for so many points in all.
    void reserve(size_t points);
    /// values: width() of them.
    void add(const Vec3& p, const Vec3& n, float r, std::span<const float> values);
    /// Box about the points. Both 0 where there are none.
    void bounds(Vec3& lo, Vec3& hi) const;
};

/// Concatenates several clouds with the union of their channels; missing numbers are 0. Returns "", or an error if a name has two
/// types.
std::string merge(std::span<const PointCloud> from, PointCloud& into);

/// Merges the points of a cloud in each cell of a cube divided 2^depth times along each side: one point by cell and orientation
/// of the normal (six, and none). Positions, normals and channels are means by area; the disk has the total area. Cells in order
/// x, y, z.
PointCloud coarser(const PointCloud&, const Vec3& corner, float side, int depth);

} // namespace alpenglow::pointcloud

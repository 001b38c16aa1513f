// Point clouds: points of surfaces with what shaders wrote there (bake3d), in the order in which they were written
// (3Delight manual, 6.4.6, tables 6.17 and 6.18).
#pragma once
#include "base/vec.h"
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::clouds {

/// What the numbers of a channel mean: it decides what spaces do to them.
enum class ChannelType : uint8_t { Float = 0, Color = 1, Point = 2, Vector = 3, Normal = 4, Matrix = 5 };
const char* nameOf(ChannelType);
inline int sizeOf(ChannelType t) { return t == ChannelType::Float ? 1 : t == ChannelType::Matrix ? 16 : 3; }

struct Channel {
    std::string name;
    ChannelType type = ChannelType::Float;
    bool operator==(const Channel&) const = default;
};

struct PointCloud {
    std::vector<Channel> channels;
    std::vector<Vec3> P, N;    ///< N: unit, or 0 where a point is a ball and no disk
    std::vector<float> radius; ///< of the disk or the ball
    std::vector<float> values; ///< width() a point
    size_t size() const { return P.size(); }
    int width() const; ///< numbers of the channels of one point
    /// Where the numbers of a channel begin; -1: there is none.
    int offsetOf(const std::string& name) const;
    std::span<const float> valuesOf(size_t point) const { return {values.data() + point * size_t(width()), size_t(width())}; }
    void reserve(size_t points);
    /// values: width() of them.
    void add(const Vec3& p, const Vec3& n, float r, std::span<const float> values);
    /// Box about the points. Both 0 where there are none.
    void bounds(Vec3& lo, Vec3& hi) const;
};

/// All points of several clouds one behind the other. Channels of any; where a cloud has none its numbers are 0. A name that has
/// two types: "", else what is wrong.
std::string merge(std::span<const PointCloud> from, PointCloud& into);

/// The points of a cloud that stand for those in each cell of a cube about it that is cut 2^depth times along each side: by cell
/// and by the side to which normals look (six, and none). Positions, normals and channels are means by area; the disk has the
/// area of all. Cells in the order x, y, z.
PointCloud coarser(const PointCloud&, const Vec3& corner, float side, int depth);

} // namespace alpenglow::clouds

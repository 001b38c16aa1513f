#include "pointcloud/pointcloud.h"
#include "pointcloud/area.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow::pointcloud {

const char* nameOf(ChannelType t) {
    constexpr const char* names[] = {"float", "color", "point", "vector", "normal", "matrix"};
    return names[size_t(t)];
}

int PointCloud::width() const {
    int w = 0;
    for (const Channel& c : channels) w += sizeOf(c.type);
    return w;
}

int PointCloud::offsetOf(const std::string& name) const {
    int at = 0;
    for (const Channel& c : channels) {
        if (c.name == name) return at;
        at += sizeOf(c.type);
    }
    return -1;
}

void PointCloud::reserve(size_t points) {
    P.reserve(points);
    N.reserve(points);
    radius.reserve(points);
    values.reserve(points * size_t(width()));
}

void PointCloud::add(const Vec3& p, const Vec3& n, float r, std::span<const float> v) {
    P.push_back(p);
    N.push_back(n);
    radius.push_back(r);
    values.insert(values.end(), v.begin(), v.end());
}

void PointCloud::bounds(Vec3& lo, Vec3& hi) const {
    lo = hi = P.empty() ? Vec3(0.f) : P[0];
    for (const Vec3& p : P)
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], p[k]);
            hi[k] = std::max(hi[k], p[k]);
        }
}

std::string merge(std::span<const PointCloud> from, PointCloud& into) {
    into = {};
    size_t points = 0;
    for (const PointCloud& c : from) {
        points += c.size();
        for (const Channel& channel : c.channels) {
            const auto same = [&](const Channel& other) { return other.name == channel.name; };
            const auto known = std::find_if(into.channels.begin(), into.channels.end(), same);
            if (known == into.channels.end()) into.channels.push_back(channel);
            else if (known->type != channel.type)
                return "channel \"" + channel.name + "\" is " + nameOf(known->type) + " in one and " + nameOf(channel.type) +
                       " in another";
        }
    }
    into.reserve(points);
    std::vector<float> row;
    for (const PointCloud& c : from) {
        std::vector<int> to; // by number of a point of c
        for (const Channel& channel : c.channels)
            for (int k = 0, at = into.offsetOf(channel.name); k < sizeOf(channel.type); ++k) to.push_back(at + k);
        for (size_t i = 0; i < c.size(); ++i) {
            row.assign(size_t(into.width()), 0.f);
            const auto values = c.valuesOf(i);
            for (size_t k = 0; k < values.size(); ++k) row[size_t(to[k])] = values[k];
            into.add(c.P[i], c.N[i], c.radius[i], row);
        }
    }
    return "";
}

namespace {

/// The side to which a normal looks: 0 to 5, and 6 for none.
uint32_t sideOf(const Vec3& n) {
    const float x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
    if (!(x + y + z > 0)) return 6;
    const int axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    return uint32_t(2 * axis + (n[axis] < 0));
}

struct Cell {
    std::array<uint32_t, 4> at; ///< x, y, z, side
    uint32_t point;
};

/// Merges the points begin to end, of one cell, into one.
void addMean(const PointCloud& from, std::span<const Cell> cell, std::vector<double>& sums, std::vector<float>& row,
             PointCloud& to) {
    const size_t width = size_t(from.width());
    const int channel = areaChannel(from);
    Vec3d p(0.0), n(0.0);
    double all = 0, area = 0;
    sums.assign(width, 0);
    for (const Cell& c : cell) {
        const double w = areaOf(from, c.point, channel);
        area += from.radius[c.point] > 0 || channel >= 0 ? w : 0;
        all += w;
        p = p + Vec3d(from.P[c.point]) * w;
        n = n + Vec3d(from.N[c.point]) * w;
        const auto values = from.valuesOf(c.point);
        for (size_t k = 0; k < width; ++k) sums[k] += w * double(values[k]);
    }
    row.resize(width);
    for (size_t k = 0; k < width; ++k) row[k] = float(sums[k] / all);
    if (channel >= 0) row[size_t(channel)] = float(all);
    const double l = length(n);
    to.add(Vec3(p / all), l > 0 ? Vec3(n / l) : Vec3(0.f), float(std::sqrt(area / 2)), row);
}

} // namespace

PointCloud coarser(const PointCloud& from, const Vec3& corner, float side, int depth) {
    const uint32_t cuts = 1u << std::clamp(depth, 0, 20);
    std::vector<Cell> cells(from.size());
    for (size_t i = 0; i < from.size(); ++i) {
        Cell& c = cells[i];
        for (int k = 0; k < 3; ++k) {
            const double x = side > 0 ? (double(from.P[i][k]) - double(corner[k])) / double(side) * cuts : 0;
            c.at[size_t(k)] = uint32_t(std::clamp(x, 0.0, double(cuts - 1)));
        }
        c.at[3] = sideOf(from.N[i]);
        c.point = uint32_t(i);
    }
    std::sort(cells.begin(), cells.end(),
              [](const Cell& a, const Cell& b) { return a.at != b.at ? a.at < b.at : a.point < b.point; });
    PointCloud to;
    to.channels = from.channels;
    std::vector<double> sums;
    std::vector<float> row;
    for (size_t i = 0, end; i < cells.size(); i = end) {
        for (end = i + 1; end < cells.size() && cells[end].at == cells[i].at;) ++end;
        addMean(from, std::span(cells).subspan(i, end - i), sums, row, to);
    }
    return to;
}

} // namespace alpenglow::pointcloud

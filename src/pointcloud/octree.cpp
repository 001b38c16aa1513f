#include "pointcloud/octree.h"
#include "pointcloud/area.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace alpenglow::pointcloud {

namespace {

constexpr uint32_t kLeaf = 8;
constexpr double kMostArea = 1e29; ///< of a point: the sum of all is a float
constexpr int kBits = 21;          ///< of each coordinate in a code

/// Real spherical harmonics of a unit vector, bands 0 to 2.
PointOctree::Harmonics harmonics(const Vec3& d) {
    return {.282095f,
            .488603f * d.y,
            .488603f * d.z,
            .488603f * d.x,
            1.092548f * d.x * d.y,
            1.092548f * d.y * d.z,
            .315392f * (3 * d.z * d.z - 1),
            1.092548f * d.x * d.z,
            .546274f * (d.x * d.x - d.y * d.y)};
}

/// The bands of max(0, cos) (Ramamoorthi and Hanrahan 2001).
constexpr float kBand[9] = {kFloatPi,     2 * kFloatPi / 3, 2 * kFloatPi / 3, 2 * kFloatPi / 3, kFloatPi / 4,
                            kFloatPi / 4, kFloatPi / 4,     kFloatPi / 4,     kFloatPi / 4};

/// Lengths of the mean of unit normals at which a node starts to count as planar, and fully does.
constexpr float kCurved = .85f, kFlat = .97f;

/// Bits of a coordinate, two zeros behind each.
uint64_t spread(uint64_t x) {
    x = (x | x << 32) & 0x1f00000000ffff;
    x = (x | x << 16) & 0x1f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    return (x | x << 2) & 0x1249249249249249;
}

} // namespace

float PointOctree::Point::radius() const { return dot(N, N) > 0 ? std::sqrt(area / 2) : std::sqrt(area / kFloatPi); }

PointOctree::PointOctree(const PointCloud& cloud, const std::string& lightChannel) {
    const int area = areaChannel(cloud);
    int light = -1, numbers = 0;
    for (const Channel& c : cloud.channels)
        if (!lightChannel.empty() && c.name == lightChannel) light = cloud.offsetOf(c.name), numbers = sizeOf(c.type);
    lit_ = light >= 0;
    std::vector<uint32_t> order;
    order.reserve(cloud.size());
    for (size_t i = 0; i < cloud.size(); ++i) {
        const bool has = cloud.radius[i] > 0 || (area >= 0 && cloud.valuesOf(i)[size_t(area)] > 0);
        const bool finite = std::isfinite(dot(cloud.P[i], Vec3(1))) && std::isfinite(dot(cloud.N[i], Vec3(1)));
        if (has && finite && areaOf(cloud, i, area) < kMostArea) order.push_back(uint32_t(i));
        else ++leftOut_;
    }
    if (order.empty()) return;
    Vec3 lo = cloud.P[order[0]], hi = lo;
    for (const uint32_t i : order)
        for (int k = 0; k < 3; ++k) {
            lo[k] = std::min(lo[k], cloud.P[i][k]);
            hi[k] = std::max(hi[k], cloud.P[i][k]);
        }
    const double side = std::max({double(hi.x) - lo.x, double(hi.y) - lo.y, double(hi.z) - lo.z, 1e-30});
    std::vector<std::pair<uint64_t, uint32_t>> coded(order.size());
    for (size_t n = 0; n < order.size(); ++n) {
        uint64_t code = 0;
        for (int k = 0; k < 3; ++k) {
            const double cell = (double(cloud.P[order[n]][k]) - lo[k]) / side * double(1 << kBits);
            code |= spread(uint64_t(std::clamp(cell, 0.0, double((1 << kBits) - 1)))) << k;
        }
        coded[n] = {code, order[n]};
    }
    std::sort(coded.begin(), coded.end());
    points_.reserve(order.size());
    std::vector<uint64_t> codes;
    codes.reserve(order.size());
    for (const auto& [code, i] : coded) {
        codes.push_back(code);
        Point p{cloud.P[i], cloud.N[i], float(areaOf(cloud, i, area)), Color(0)};
        if (const float l = length(p.N); l > 0) p.N = p.N / l;
        for (int k = 0; k < 3 && light >= 0; ++k) p.light[k] = cloud.valuesOf(i)[size_t(light + (numbers == 3 ? k : 0))];
        points_.push_back(p);
    }
    nodes_.emplace_back();
    build(0, 0, uint32_t(points_.size()), 3 * (kBits - 1), codes);
}

/// By three bits of the codes a level; levels in which all points are in one cell are left out.
void PointOctree::build(uint32_t at, uint32_t begin, uint32_t end, int shift, std::span<const uint64_t> codes) {
    nodes_[at].begin = begin;
    nodes_[at].end = end;
    while (shift >= 0 && end - begin > kLeaf && (codes[begin] >> shift & 7) == (codes[end - 1] >> shift & 7)) shift -= 3;
    if (end - begin > kLeaf && shift >= 0) {
        uint32_t ends[8], count = 0;
        for (uint32_t i = begin; i < end; ++i)
            if (i + 1 == end || (codes[i] >> shift & 7) != (codes[i + 1] >> shift & 7)) ends[count++] = i + 1;
        const uint32_t first = uint32_t(nodes_.size());
        nodes_[at].first = first;
        nodes_[at].children = count;
        nodes_.resize(nodes_.size() + count);
        for (uint32_t k = 0, from = begin; k < count; from = ends[k++]) build(first + k, from, ends[k], shift - 3, codes);
    }
    sum(nodes_[at]);
}

void PointOctree::sum(Node& n) const {
    std::array<double, 9> seen{}, sent[3]{};
    double area = 0, ball = 0, power[3] = {}, ballPower[3] = {};
    Vec3d centre(0);
    if (n.children) {
        for (uint32_t c = n.first; c < n.first + n.children; ++c) {
            const Node& m = nodes_[c];
            area += m.area, ball += m.ball;
            centre += Vec3d(m.centre) * double(m.area);
            for (size_t j = 0; j < 9; ++j) seen[j] += m.seen[j];
            for (int k = 0; k < 3; ++k) {
                power[k] += m.power[k], ballPower[k] += m.ballPower[k];
                for (size_t j = 0; j < 9; ++j) sent[k][j] += m.sent[size_t(k)][j];
            }
        }
    } else {
        for (uint32_t i = n.begin; i < n.end; ++i) {
            const Point& p = points_[i];
            const bool isBall = !(dot(p.N, p.N) > 0);
            const Harmonics h = harmonics(p.N);
            area += p.area;
            centre += Vec3d(p.P) * double(p.area);
            if (isBall) ball += p.area;
            for (size_t j = 0; j < 9 && !isBall; ++j) seen[j] += double(p.area * kBand[j] * h[j]);
            for (int k = 0; k < 3; ++k) {
                power[k] += double(p.area * p.light[k]);
                if (isBall) ballPower[k] += double(p.area * p.light[k]);
                for (size_t j = 0; j < 9 && !isBall; ++j) sent[k][j] += double(p.area * p.light[k] * kBand[j] * h[j]);
            }
        }
    }
    n.area = float(area), n.ball = float(ball);
    n.centre = Vec3(centre / area);
    for (size_t j = 0; j < 9; ++j) n.seen[j] = float(seen[j]);
    for (int k = 0; k < 3; ++k) {
        n.power[k] = float(power[k]), n.ballPower[k] = float(ballPower[k]);
        for (size_t j = 0; j < 9; ++j) n.sent[size_t(k)][j] = float(sent[k][j]);
    }
    float reach = 0;
    if (n.children)
        for (uint32_t c = n.first; c < n.first + n.children; ++c)
            reach = std::max(reach, length(nodes_[c].centre - n.centre) + nodes_[c].reach);
    else
        for (uint32_t i = n.begin; i < n.end; ++i) reach = std::max(reach, length(points_[i].P - n.centre) + points_[i].radius());
    n.reach = reach;
}

float PointOctree::seenFrom(const Node& n, const Vec3& towards, DiskSides sides, Color* sent) {
    Harmonics h = harmonics(towards);
    // Seen from the other side odd bands change their sign: both sides together have none.
    const float odd = sides == DiskSides::Both ? 0.f : sides == DiskSides::Back ? -1.f : 1.f;
    const float even = sides == DiskSides::Both ? 2.f : 1.f;
    for (size_t j = 0; j < 9; ++j) h[j] *= j >= 1 && j <= 3 ? odd : even;
    const auto value = [&](const Harmonics& f) {
        float v = 0;
        for (size_t j = 0; j < 9; ++j) v += f[j] * h[j];
        return std::max(0.f, v);
    };
    // The band of cosines is the sum of normals by area. Where they are alike the node is a piece of a plane, which three bands
    // do not have well.
    const float disks = n.area - n.ball;
    const Vec3 normals = Vec3(n.seen[3], n.seen[1], n.seen[2]) / (.488603f * kBand[1]);
    const float l = length(normals), flat = disks > 0 ? std::clamp((l / disks - kCurved) / (kFlat - kCurved), 0.f, 1.f) : 0.f;
    const float c = l > 0 ? dot(normals, towards) / l : 0;
    const float plane = sides == DiskSides::Both ? std::fabs(c) : std::max(0.f, sides == DiskSides::Back ? -c : c);
    if (sent)
        for (int k = 0; k < 3; ++k)
            (*sent)[k] = value(n.sent[size_t(k)]) * (1 - flat) + (n.power[k] - n.ballPower[k]) * plane * flat + n.ballPower[k];
    return std::min(value(n.seen), disks) * (1 - flat) + disks * plane * flat + n.ball;
}

} // namespace alpenglow::pointcloud

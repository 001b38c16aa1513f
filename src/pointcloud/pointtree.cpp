#include "pointcloud/pointtree.h"
#include "pointcloud/area.h"
#include <algorithm>
#include <array>
#include <cmath>

namespace alpenglow::pointcloud {

namespace {
constexpr uint32_t kLeafPoints = 8;
}

PointTree::PointTree(PointCloud from) {
    std::vector<uint32_t> order(from.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t(i);
    if (!order.empty()) build(order, from, 0, uint32_t(order.size()));
    cloud_.channels = from.channels;
    cloud_.reserve(from.size());
    for (const uint32_t i : order) cloud_.add(from.P[i], from.N[i], from.radius[i], from.valuesOf(i));
}

/// Halves by the longest side of the box; order among equals is that of the file.
void PointTree::build(std::vector<uint32_t>& order, const PointCloud& from, uint32_t begin, uint32_t end) {
    const size_t at = nodes_.size();
    Node n;
    n.begin = begin;
    n.end = end;
    n.lo = n.hi = from.P[order[begin]];
    for (uint32_t i = begin; i < end; ++i) {
        const Vec3& p = from.P[order[i]];
        n.radius = std::max(n.radius, from.radius[order[i]]);
        for (int k = 0; k < 3; ++k) {
            n.lo[k] = std::min(n.lo[k], p[k]);
            n.hi[k] = std::max(n.hi[k], p[k]);
        }
    }
    nodes_.push_back(n);
    if (end - begin <= kLeafPoints) return;
    const Vec3 side = n.hi - n.lo;
    const int axis = side.x >= side.y && side.x >= side.z ? 0 : side.y >= side.z ? 1 : 2;
    const uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](uint32_t a, uint32_t b) {
        const float x = from.P[a][axis], y = from.P[b][axis];
        return x != y ? x < y : a < b;
    });
    // The partition at the median is unique; its internal order is not, so leaves are sorted by index.
    std::sort(order.begin() + begin, order.begin() + middle);
    std::sort(order.begin() + middle, order.begin() + end);
    build(order, from, begin, middle);
    nodes_[at].second = uint32_t(nodes_.size());
    build(order, from, middle, end);
}

void PointTree::gather(const Query& q, double* weight, std::span<double> sums) const {
    if (nodes_.empty()) return;
    std::array<uint32_t, 64> stack;
    int depth = 0;
    stack[size_t(depth++)] = 0;
    const bool turned = dot(q.N, q.N) > 0;
    const int channel = areaChannel(cloud_);
    while (depth > 0) {
        const uint32_t at = stack[size_t(--depth)];
        const Node& n = nodes_[at];
        const float reach = q.radius + 2 * n.radius;
        double away = 0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({0.0, double(n.lo[k]) - double(q.P[k]), double(q.P[k]) - double(n.hi[k])});
            away += d * d;
        }
        if (!(away < double(reach) * double(reach))) continue;
        if (n.second) {
            stack[size_t(depth++)] = n.second;
            stack[size_t(depth++)] = at + 1;
            continue;
        }
        for (uint32_t i = n.begin; i < n.end; ++i) {
            const Vec3d d = Vec3d(cloud_.P[i]) - Vec3d(q.P);
            const double r = cloud_.radius[i], h = double(q.radius) + 2 * r, d2 = dot(d, d);
            if (!(d2 < h * h)) continue;
            const double near = 1 - d2 / (h * h);
            double w = near * near * areaOf(cloud_, i, channel);
            if (const Vec3& m = cloud_.N[i]; turned && dot(m, m) > 0) {
                const double sum = r + double(q.radius);
                w *= std::max(0.0, 1 - (1 - double(dot(q.N, m))) * (1 + (sum > 0 ? 2 * r / sum : 0)));
            }
            if (!(w > 0)) continue;
            *weight += w;
            const auto values = cloud_.valuesOf(i);
            for (size_t k = 0; k < values.size(); ++k) sums[k] += w * double(values[k]);
        }
    }
}

size_t PointTree::bytes() const {
    return sizeof *this + cloud_.size() * (28 + 4 * size_t(cloud_.width())) + nodes_.size() * sizeof(Node);
}

} // namespace alpenglow::pointcloud

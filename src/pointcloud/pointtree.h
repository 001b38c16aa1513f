// Finds points within each point's own radius: boxes store the largest radius inside. The same points give the same tree.
#pragma once
#include "pointcloud/map.h"

namespace alpenglow::pointcloud {

/// The points of a cloud, for lookups.
class PointTree {
public:
    PointTree() = default;
    /// Sorts the points of the cloud.
    explicit PointTree(PointCloud);
    const PointCloud& cloud() const { return cloud_; } ///< in the order of the tree
    /// Largest radius of a point; 0: no points.
    float largest() const { return nodes_.empty() ? 0 : nodes_[0].radius; }
    /// Adds the points that count for a query: weights to *weight, weight times values to sums. See CloudMap::lookup().
    void gather(const Query&, double* weight, std::span<double> sums) const;
    /// Memory of the tree and its points.
    size_t bytes() const;

private:
    struct Node {
        Vec3 lo, hi;
        float radius = 0; ///< the largest
        uint32_t begin = 0, end = 0;
        uint32_t second = 0; ///< the second half; the first is the next node. 0: a leaf
    };
    void build(std::vector<uint32_t>& order, const PointCloud& from, uint32_t begin, uint32_t end);
    PointCloud cloud_;
    std::vector<Node> nodes_;
};

} // namespace alpenglow::pointcloud

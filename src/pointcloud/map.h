// Lookups in point clouds and brick maps, for texture3d().
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/pointcloud.h"
#include <memory>

namespace alpenglow::pointcloud {

/// In the space of the file.
struct Query {
    Vec3 P, N;         ///< N: 0, all normals fit
    float radius = 0;  ///< of the filter
    int maxDepth = -1; ///< the finest level that is read, 0 the coarsest; -1: all
};

/// A point cloud or a brick map, opened for lookups. Thread safe.
class CloudMap {
public:
    virtual ~CloudMap() = default;
    /// In the order of their numbers.
    virtual const std::vector<Channel>& channels() const = 0;
    /// Numbers of a point, of all channels.
    int width() const;
    /// Index of a channel's first number; -1: no such channel.
    int offsetOf(const std::string& name) const;
    /// Weighted mean around a point, width() numbers. Returns false, with `out` unchanged, if there are no points. A point with
    /// disk radius r within h = radius + 2 r of P has weight (1 - d^2 / h^2)^2 times max(0, 1 - (1 - N.n) (1 + 2 r / (r +
    /// radius))), so large disks are more selective by normal. Filters wider than the spacing of points read coarser levels.
    /// Thread safe; the same bits for any caller.
    virtual bool lookup(const Query&, std::span<float> out) const = 0;
};

/// A point cloud in memory.
std::shared_ptr<const CloudMap> mapOf(PointCloud);

/// Reads a point cloud (.ptc or .ply, by its first bytes) or opens a brick map. Null: an error was reported.
std::shared_ptr<const CloudMap> openMap(const std::string& path, Diagnostics&, const SourcePlace& = {});

} // namespace alpenglow::pointcloud

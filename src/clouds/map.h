// Looking up in point clouds and brick maps: what texture3d() answers.
#pragma once
#include "base/diagnostics.h"
#include "clouds/pointcloud.h"
#include <memory>

namespace alpenglow::clouds {

/// In the space of the file.
struct Query {
    Vec3 P, N;         ///< N: 0, all normals fit
    float radius = 0;  ///< of the filter
    int maxDepth = -1; ///< the finest level that is read, 0 the coarsest; -1: all
};

class CloudMap {
public:
    virtual ~CloudMap() = default;
    virtual const std::vector<Channel>& channels() const = 0;
    int width() const;
    int offsetOf(const std::string& name) const;
    /// The mean about a point, width() numbers. False: nothing is there, and `out` is as it was. A point of the cloud with radius
    /// r counts within h = radius + 2 r of P by (1 - d^2 / h^2)^2 and by how its normal fits: by 1 - (1 - N.n) (1 + 2 r / (r +
    /// radius)), not below 0, so that large disks are choosier. Filters wider than the points are dense read coarser levels.
    /// Thread safe; the same bits whoever asks.
    virtual bool lookup(const Query&, std::span<float> out) const = 0;
};

/// A point cloud in memory.
std::shared_ptr<const CloudMap> mapOf(PointCloud);

/// Reads a point cloud (.ptc or .ply, by its first bytes) or opens a brick map. Null: an error was reported.
std::shared_ptr<const CloudMap> openMap(const std::string& path, Diagnostics&, const SourcePlace& = {});

} // namespace alpenglow::clouds

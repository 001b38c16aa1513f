#include "pointcloud/map.h"
#include "pointcloud/brickmap.h"
#include "pointcloud/cloudfile.h"
#include "pointcloud/pointtree.h"
#include <array>
#include <cmath>
#include <mutex>

namespace alpenglow::pointcloud {

int CloudMap::width() const {
    int w = 0;
    for (const Channel& c : channels()) w += sizeOf(c.type);
    return w;
}

int CloudMap::offsetOf(const std::string& name) const {
    int at = 0;
    for (const Channel& c : channels()) {
        if (c.name == name) return at;
        at += sizeOf(c.type);
    }
    return -1;
}

bool meanOf(double weight, std::span<const double> sums, std::span<float> out) {
    if (!(weight > 0)) return false;
    for (size_t k = 0; k < sums.size(); ++k) out[k] = float(sums[k] / weight);
    return true;
}

void cubeAbout(const PointCloud& cloud, Vec3* corner, float* side) {
    Vec3 hi;
    cloud.bounds(*corner, hi);
    *side = std::max({hi.x - corner->x, hi.y - corner->y, hi.z - corner->z});
}

int depthFor(float side, float radius) {
    int depth = 0;
    while (depth < kDeepest && side > radius / 2) side /= 2, ++depth;
    return depth;
}

namespace {

/// A cloud in memory; coarser levels are made at first use.
class MemoryMap final : public CloudMap {
public:
    explicit MemoryMap(PointCloud cloud) : whole_(std::move(cloud)) { cubeAbout(whole_.cloud(), &corner_, &side_); }
    const std::vector<Channel>& channels() const override { return whole_.cloud().channels; }
    bool lookup(const Query& q, std::span<float> out) const override {
        double weight = 0;
        std::vector<double> sums(out.size());
        treeFor(q).gather(q, &weight, sums);
        return meanOf(weight, sums, out);
    }

private:
    const PointTree& treeFor(const Query& q) const {
        const int wanted = depthFor(side_, q.radius), depth = q.maxDepth >= 0 ? std::min(wanted, q.maxDepth) : wanted;
        if (depth >= kDeepest || whole_.cloud().size() < 2) return whole_;
        Level& level = levels_[size_t(depth)];
        std::call_once(level.made, [&] {
            PointCloud c = coarser(whole_.cloud(), corner_, side_, depth);
            if (c.size() < whole_.cloud().size()) level.tree = std::make_unique<PointTree>(std::move(c));
        });
        return level.tree ? *level.tree : whole_;
    }
    struct Level {
        std::once_flag made;
        std::unique_ptr<PointTree> tree; ///< null: cells have one point each
    };
    PointTree whole_;
    Vec3 corner_;
    float side_ = 0;
    mutable std::array<Level, kDeepest> levels_; ///< a cache: each is made once, whoever asks first
};

} // namespace

std::shared_ptr<const CloudMap> mapOf(PointCloud cloud) { return std::make_shared<MemoryMap>(std::move(cloud)); }

std::shared_ptr<const CloudMap> openMap(const std::string& path, Diagnostics& d, const SourcePlace& place) {
    if (isBrickMap(path)) return openBrickMap(path, d, place);
    auto cloud = loadCloud(path, d, place);
    return cloud ? mapOf(std::move(*cloud)) : nullptr;
}

} // namespace alpenglow::pointcloud

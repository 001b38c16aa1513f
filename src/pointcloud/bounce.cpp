#include "pointcloud/bounce.h"
#include "pointcloud/hemisphere.h"
#include <algorithm>
#include <atomic>
#include <thread>

namespace alpenglow::pointcloud {

namespace {

/// The channel that is a colour or a float; null: none.
const Channel* colourNamed(const PointCloud& c, const std::string& name) {
    for (const Channel& channel : c.channels)
        if (channel.name == name && (sizeOf(channel.type) == 1 || sizeOf(channel.type) == 3)) return &channel;
    return nullptr;
}

/// Computes the light that arrives at disks from index `begin` on.
void arrive(const PointCloud& cloud, const PointOctree& octree, float solidAngle, size_t begin, size_t end,
            std::vector<Color>& to) {
    Hemisphere h;
    for (size_t i = begin; i < end; ++i) {
        const float l = length(cloud.N[i]);
        if (!(l > 0)) continue;
        HemisphereQuery q;
        q.P = cloud.P[i];
        q.N = cloud.N[i] / l;
        q.maxSolidAngle = solidAngle;
        h.begin(q);
        h.add(octree);
        h.finish();
        to[i] = h.light();
    }
}

} // namespace

std::string bounce(PointCloud& cloud, const BounceOptions& o) {
    const Channel* light = colourNamed(cloud, "_radiosity");
    if (!light || light->type != ChannelType::Color) return "it has no color channel \"_radiosity\"";
    const Channel* albedo = o.albedoChannel.empty() ? nullptr : colourNamed(cloud, o.albedoChannel);
    if (!albedo && !o.albedoChannel.empty()) return "it has no color or float channel \"" + o.albedoChannel + "\"";
    const size_t at = size_t(cloud.offsetOf("_radiosity")), width = size_t(cloud.width());
    const std::vector<float> before = cloud.values;
    std::vector<Color> arrived(cloud.size());
    constexpr size_t kSlice = 256;
    for (int n = 0; n < o.bounces; ++n) {
        const PointOctree octree(cloud, "_radiosity");
        std::atomic<size_t> next{0};
        const auto work = [&] {
            for (size_t i; (i = next.fetch_add(kSlice)) < cloud.size();)
                arrive(cloud, octree, o.maxSolidAngle, i, std::min(cloud.size(), i + kSlice), arrived);
        };
        std::vector<std::thread> others;
        for (int t = 1; t < o.threads; ++t) others.emplace_back(work);
        work();
        for (std::thread& t : others) t.join();
        for (size_t i = 0; i < cloud.size(); ++i)
            for (size_t k = 0; k < 3; ++k) {
                const float a =
                    !albedo ? o.albedo[int(k)]
                            : before[i * width + size_t(cloud.offsetOf(albedo->name)) + (sizeOf(albedo->type) == 3 ? k : 0)];
                cloud.values[i * width + at + k] = before[i * width + at + k] + a * arrived[i][int(k)];
            }
    }
    return "";
}

} // namespace alpenglow::pointcloud

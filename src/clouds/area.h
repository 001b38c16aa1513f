// How much of a surface a point stands for.
#pragma once
#include "clouds/pointcloud.h"

namespace alpenglow::clouds {

/// The channel that says it; -1: the disks do.
inline int areaChannel(const PointCloud& c) {
    for (const Channel& channel : c.channels)
        if (channel.name == "_area" && channel.type == ChannelType::Float) return c.offsetOf("_area");
    return -1;
}
/// The channel's number; where that is none, the square whose corners lie on the disk; 1 where that is none, too.
inline double areaOf(const PointCloud& c, size_t point, int channel) {
    const double r = double(c.radius[point]), said = channel < 0 ? 0 : double(c.valuesOf(point)[size_t(channel)]);
    return said > 0 ? said : r > 0 ? 2 * r * r : 1;
}

} // namespace alpenglow::clouds

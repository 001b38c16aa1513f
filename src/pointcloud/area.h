// The surface area that a point represents.
#pragma once
#include "pointcloud/pointcloud.h"

namespace alpenglow::pointcloud {

/// The channel with the area; -1: use the disks.
inline int areaChannel(const PointCloud& c) {
    for (const Channel& channel : c.channels)
        if (channel.name == "_area" && channel.type == ChannelType::Float) return c.offsetOf("_area");
    return -1;
}
/// The value of the channel; without a channel the square inscribed in the disk; 1 without a disk.
inline double areaOf(const PointCloud& c, size_t point, int channel) {
    const double r = double(c.radius[point]), reported = channel < 0 ? 0 : double(c.valuesOf(point)[size_t(channel)]);
    return reported > 0 ? reported : r > 0 ? 2 * r * r : 1;
}

} // namespace alpenglow::pointcloud

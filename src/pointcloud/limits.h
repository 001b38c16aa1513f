// Limits of point clouds, in addition to base/limits.h.
#pragma once
#include <cstddef>
#include <cstdint>

namespace alpenglow::limits {

inline constexpr uint64_t kCloudPoints = 200'000'000;      ///< of one point cloud
inline constexpr size_t kCloudBytes = size_t(16) << 30;    ///< of its numbers in memory, and of all that one frame bakes
inline constexpr uint64_t kOctreePoints = 50'000'000;      ///< of a cloud that point-based shadeops read: about 100 bytes each
inline constexpr size_t kShearedOctrees = 64;              ///< cached in memory; others are made for each use
inline constexpr size_t kCloudFragments = size_t(1) << 20; ///< fragments of clusters in a sorted lookup before some are merged
inline constexpr int kCloudChannels = 256;                 ///< numbers of one point in addition to position, normal and radius
inline constexpr size_t kBrickMemory = size_t(256) << 20;  ///< of points in memory while a brick map is made of a larger cloud
inline constexpr int kBakedSide = 8192;                    ///< of the picture that a .bake file becomes

} // namespace alpenglow::limits

// Brick maps of point clouds that need not fit into memory: the cloud is sorted into cubes on disk, which become bricks one by
// one.
#pragma once
#include "base/diagnostics.h"
#include "pointcloud/limits.h"
#include <cstddef>
#include <span>
#include <string>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::pointcloud {

/// Makes one map of several clouds, as merge() and saveBrickMap() would, except that means in the coarsest levels may differ in
/// the last bits. `memory`: approximate size of the points held at once, in bytes; more if very many are at one position. Clouds
/// that fit, and PLY files, are read completely. Returns false after an error, which is reported; an existing file is then
/// unchanged.
bool brickMapOfFiles(std::span<const std::string> clouds, const std::string& name, const OutputPolicy&, Diagnostics&,
                     const SourcePlace& = {}, size_t memory = limits::kBrickMemory);

} // namespace alpenglow::pointcloud

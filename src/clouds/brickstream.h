// Brick maps of point clouds that need not fit into memory: the cloud is sorted into cubes on disk, which become bricks one by
// one.
#pragma once
#include "base/diagnostics.h"
#include "clouds/limits.h"
#include <cstddef>
#include <span>
#include <string>

namespace alpenglow {
struct OutputPolicy;
}

namespace alpenglow::clouds {

/// The map of these clouds together, as of merge() and saveBrickMap(), but that means of the coarsest levels may differ in their
/// last bits. `memory`: bytes that points take at a time, about; more where very many lie in one place. Clouds that fit, and PLY
/// files, are read whole. False: an error was reported, and what was there before still is.
bool brickMapOfFiles(std::span<const std::string> clouds, const std::string& name, const OutputPolicy&, Diagnostics&,
                     const SourcePlace& = {}, size_t memory = limits::kBrickMemory);

} // namespace alpenglow::clouds

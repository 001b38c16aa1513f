// OpenVDB grids, read by a module (display/foreign.h).
#pragma once
#include "texture/volume.h"

namespace alpenglow::texture {

/// Reads the floats and vectors of a file, in the bounding box of active voxels of its grids, x to the right, y downward, z from
/// slice to slice: (0, 0, 0) is the corner with the smallest coordinates. Returns nothing after an error, which is reported.
std::optional<Volume> loadVdb(const std::string& path, Diagnostics&, const SourcePlace&);

} // namespace alpenglow::texture

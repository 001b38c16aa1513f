// Grids of OpenVDB, through the module that knows them (display/foreign.h).
#pragma once
#include "texture/volume.h"

namespace alpenglow::texture {

/// The floats and vectors of a file, in the box about what is active in any of its grids, x to the right, y downward, z from
/// slice to slice: (0, 0, 0) is the corner with the smallest coordinates. Nothing: an error was reported.
std::optional<Volume> loadVdb(const std::string& path, Diagnostics&, const SourcePlace&);

} // namespace alpenglow::texture

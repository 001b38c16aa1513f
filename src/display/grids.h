// Grids of voxels in files of OpenVDB, read by a module (display/foreign.h).
#pragma once
#include "base/diagnostics.h"
#include "display/image.h"
#include <optional>

namespace alpenglow::display {

/// Slices one below the other; "depth" in the metadata says how many. Nothing: an error was reported.
std::optional<Image> readGrids(const std::string& path, Diagnostics&, const SourcePlace& = {});

} // namespace alpenglow::display

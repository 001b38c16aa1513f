// Grids of voxels in files of OpenVDB, read by a module (display/foreign.h).
#pragma once
#include "base/diagnostics.h"
#include "display/image.h"
#include <optional>

namespace alpenglow::display {

/// Reads the slices, below each other; "depth" in the metadata is their number. Returns nothing after an error, which is
/// reported.
std::optional<Image> readGrids(const std::string& path, Diagnostics&, const SourcePlace& = {});

} // namespace alpenglow::display

// Transfer curves of pictures for viewing (docs/colour.md).
#pragma once
#include "render/outputs.h"

namespace alpenglow::render {

/// Whether a picture is for viewing: PNG, JPEG or TIFF with 8 bits, with a colour.
bool isLookedAt(const OutputSpec&);

/// Sets srgb and curve of a picture whose exposure and quantiser are set.
void chooseCurve(OutputSpec&, const OutputBasis&);

/// The curves of all pictures, for the table: "sRGB" or "sRGB (a.png), none, by Exposure (b.tif)"; "none: the numbers are light"
/// if no picture is for viewing.
std::string curvesOf(const OutputPlan&);

} // namespace alpenglow::render

// How light becomes the numbers of a picture that is looked at (docs/colour.md).
#pragma once
#include "render/outputs.h"

namespace alpenglow::render {

/// Whether a picture is made to be looked at: PNG, JPEG or TIFF of 8 bits, with a colour in it.
bool isLookedAt(const OutputSpec&);

/// Sets srgb and curve of a picture whose exposure and quantiser are set.
void chooseCurve(OutputSpec&, const OutputBasis&);

/// For the table: the curves of all pictures, "sRGB" or "sRGB (a.png), none, by Exposure (b.tif)"; "none: the numbers are light"
/// where no picture is looked at.
std::string curvesOf(const OutputPlan&);

} // namespace alpenglow::render

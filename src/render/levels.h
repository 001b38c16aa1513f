// Levels of detail: which of the representations between DetailRange requests are drawn (RISpec 3.2, 4.2).
#pragma once
#include "base/diagnostics.h"
#include "render/camera.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// Pixels that a box of `bound` (xmin xmax ymin ymax zmin zmax) covers in the picture: the area of its outline, whether or not it
/// lies within the picture's edges; infinite when a corner is not in front of the eye.
double detailSize(const std::vector<float>& bound, const Matrix& toWorld, const Camera&);

/// The frame without what is too small or too large for its DetailRange, also in the instances of objects; the same frame where
/// nothing is left out. The size is that of the Detail box times RelativeDetail, infinite where no Detail was given. What is in a
/// transition is marked (transport::kLevelAttribute) with the part of the samples that see it: of adjacent ones each sample sees
/// exactly one.
std::shared_ptr<const scene::Frame> drawnLevels(std::shared_ptr<const scene::Frame>, const Camera&);

} // namespace alpenglow::render

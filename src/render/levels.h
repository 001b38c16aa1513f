// Levels of detail: selects the representations between DetailRange requests (RISpec 3.2, 4.2).
#pragma once
#include "base/diagnostics.h"
#include "render/camera.h"
#include "scene/fwd.h"

namespace alpenglow::render {

/// Area in pixels of the projected `bound` (xmin xmax ymin ymax zmin zmax), not clipped to the picture; infinite if a corner is
/// not in front of the eye.
double detailSize(const std::vector<float>& bound, const Matrix& toWorld, const Camera&);

/// The frame without objects that are too small or too large for their DetailRange, also inside object instances; the same frame
/// if nothing is removed. The size is that of the Detail box times RelativeDetail, infinite without Detail. Objects in a
/// transition are marked (scene::Attributes::level) with the fraction of samples that see them: each sample sees exactly one of
/// adjacent levels.
std::shared_ptr<const scene::Frame> drawnLevels(std::shared_ptr<const scene::Frame>, const Camera&);

} // namespace alpenglow::render

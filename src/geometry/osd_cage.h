// A cage in OpenSubdiv's form. Only for files that include OpenSubdiv.
#pragma once
#include "geometry/limit_surface.h"
#include <opensubdiv/far/topologyRefiner.h>

namespace alpenglow::geometry {

/// Returns null if OpenSubdiv rejects its topology.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(const SubdivisionCage&, const std::vector<LimitSurface::Channel>&);

} // namespace alpenglow::geometry

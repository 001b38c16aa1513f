// A cage as OpenSubdiv knows it. Only for the files that include OpenSubdiv themselves.
#pragma once
#include "geometry/limit_surface.h"
#include <opensubdiv/far/topologyRefiner.h>

namespace alpenglow::geometry {

/// Null: OpenSubdiv cannot take its topology.
std::unique_ptr<OpenSubdiv::Far::TopologyRefiner> makeRefiner(const SubdivisionCage&, const std::vector<LimitSurface::Channel>&);

} // namespace alpenglow::geometry

// What the rays of a gather have found, for the turns of its loop.
#pragma once
#include "rsl/gatherrays.h"
#include <cstddef>
#include <vector>

namespace alpenglow::transport {

/// Of each point of a strip a handful of rays, a row each.
struct GatherRows {
    int width = 1;           ///< floats of a row: GatherSite::width
    std::vector<int> counts; ///< by lane, rays of the whole statement
    std::vector<int> begins; ///< by lane, the first of the handful
    std::vector<float> rows;
    float* of(int lane, int ray) { return rows.data() + (size_t(lane) * size_t(rsl::kGatherRays) + size_t(ray)) * size_t(width); }
};

} // namespace alpenglow::transport

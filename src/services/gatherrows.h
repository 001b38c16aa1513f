// Results of the rays of a gather(), for the iterations of its loop.
#pragma once
#include "rsl/gatherrays.h"
#include "services/names.h"
#include <cstddef>
#include <vector>

namespace alpenglow::services {

/// Some rays of each point of a strip, one row each.
struct GatherRows {
    int width = 1;           ///< floats of a row: GatherSite::width
    std::vector<int> counts; ///< by lane: rays of the complete statement
    std::vector<int> begins; ///< by lane: first ray in rows
    std::vector<float> rows; ///< numbers of the rays, row after row
    /// The row of a ray that is in `rows`.
    float* of(int lane, int ray) { return rows.data() + (size_t(lane) * size_t(rsl::kGatherRays) + size_t(ray)) * size_t(width); }
};

} // namespace alpenglow::services

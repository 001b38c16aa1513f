#include "services/gatherrows.h"
#include "services/services.h"
#include "world/gathersite.h"
#include <algorithm>

namespace alpenglow::services {

void answerGatherIteration(const ServiceCall& call) {
    const auto of = call.c.gathers.find({call.s.gather->number, call.first});
    if (of == call.c.gathers.end()) return;
    GatherRows& g = of->second;
    call.each([&](int lane, const ShadePoint&) {
        const int ray = int(call.at(0, lane)) - g.begins[size_t(lane)];
        if (ray < 0 || ray >= rsl::kGatherRays) return;
        const float* row = g.of(lane, ray);
        if (row[0] < 0) row = g.of(lane, ray % int(-row[0])); // rays that serve several iterations
        for (int r = 0; r < std::min(g.width, call.s.resultRowCount); ++r) call.put(r, lane, row[r]);
    });
}

} // namespace alpenglow::services

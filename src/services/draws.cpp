// random() of shaders.
#include "services/services.h"

namespace alpenglow::services {

// Keyed by sample, path vertex, call site and number of calls at the point: independent of the other members of the batch. For
// uniform variables the key has the primitive instead. Lights have keys of their own, because their call sites start from 0 as
// those of surfaces do.
void Services::drawRandom(const ServiceCall& call) {
    const SiteInfo& s = call.s;
    KernelRun& c = call.c;
    const bool uniform = !call.d.strings.empty() && call.d.strings[0] == "uniform";
    const size_t sites = c.bound->sites.size(), points = c.points.size(), site = size_t(call.site);
    if (c.draws.size() != sites * points) c.draws.assign(sites * points, 0);
    const uint32_t light = c.light ? uint32_t(c.light - world_->lights().data()) + 1 : 0;
    call.each([&](int lane, const ShadePoint& p) {
        const size_t at = size_t(call.first + lane);
        const uint32_t turn = c.draws[site * points + at]++;
        const shading::PathRay* r = c.rays.empty() ? p.ray : &c.rays[at];
        uint32_t vertex = 0;
        if (uniform) {
            const auto shape = world_->numberOfShape().find(p.shape);
            vertex = childVertex(shape == world_->numberOfShape().end() ? 0 : world_->keyOfShape(shape->second) + 1, light, 1);
        } else {
            vertex = r ? r->vertex : uint32_t(at); // no ray: a vertex of a diced surface
        }
        if (turn > 0 || light > 0) vertex = childVertex(vertex, light, turn);
        const Random numbers = r && !uniform ? random(*r) : Random(seed_, 0, 0, 0);
        for (int k = 0; k < s.resultRowCount; ++k) call.put(k, lane, numbers.one(vertex, uint32_t(site), uint32_t(64 + k)));
    });
}

} // namespace alpenglow::services

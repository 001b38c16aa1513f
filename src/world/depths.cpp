#include "world/depths.h"
#include "world/bakes.h"
#include "world/impl.h"
#include "world/procedurals.h"

namespace alpenglow::world {
namespace {

/// Whether a kernel prints, or calls what may do anything.
bool hasEffects(const BoundKernel& k) {
    return std::any_of(k.sites.begin(), k.sites.end(),
                       [](const SiteInfo& s) { return s.kind == SiteKind::Printf || s.kind == SiteKind::Other; });
}

} // namespace

bool depthsNeedNoShaders(const World& world) {
    const auto* w = dynamic_cast<const WorldImpl*>(&world); // tests of other folders use their own World
    if (!w || !w->allOpaque() || !w->media().empty() || !w->clippingPlanes().empty() || hasDeferred(world) || bakes(world))
        return false;
    for (const SurfaceBinding& b : w->bindings())
        for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.displacementS, &b.atmosphere.kernel})
            if (hasEffects(*k)) return false;
    for (const BoundLight& l : w->lights()) {
        if (hasEffects(l.kernel)) return false;
        for (const auto& [strings, k] : l.variants)
            if (hasEffects(k)) return false;
    }
    return true;
}

} // namespace alpenglow::world

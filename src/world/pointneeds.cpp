// What must be known about points of hits and emitters: what kernels and the integrator read.
#include "world/emitterfootprint.h"

namespace alpenglow::world {

namespace {

uint32_t needsOf(const BoundLight& l) {
    if (!l.kernel || l.inAtmosphere) return geometry::kNeedAll; // a volume shader also runs there
    uint32_t needs = l.kernel.plan->needs();
    for (const auto& [strings, k] : l.variants) needs |= k.plan->needs();
    return needs | (usesFootprint(l) ? uint32_t(geometry::kNeedPartials) : 0);
}

} // namespace

void MutableWorld::setPointNeeds() {
    // Lights may query the lit surface, and footprints use partial derivatives.
    uint32_t always = needs_.footprints ? geometry::kNeedPartials : 0;
    if (needs_.facePlaces) always |= geometry::kNeedUV | geometry::kNeedPartials;
    for (const BoundLight& l : lights_) {
        if (!l.kernel) continue;
        always |= l.kernel.plan->litNeeds();
        for (const auto& [strings, k] : l.variants) always |= k.plan->litNeeds();
    }
    for (BoundLight& l : lights_) {
        l.pointNeeds = needsOf(l) | always;
        if (l.emitter) l.pointNeeds |= geometry::kNeedPartials; // needed for the density of a point
        for (int part : l.parts) l.pointNeeds |= needsOf(lights_[size_t(part)]);
    }
    if (primitiveHit_) always |= primitiveHit_.plan->needs();
    for (SurfaceBinding& b : bindings_) {
        b.pointNeeds = geometry::kNeedAll; // shaders that pass points, or whole sets of variables, to others
        if (b.displacement || b.displacementS || b.moveS || b.atmosphere.shader || b.inside >= 0 || b.outside >= 0 ||
            !b.surfaceS || lightsAsk_)
            continue;
        b.pointNeeds = always | b.surfaceS.plan->needs();
        if (b.surfaceV) b.pointNeeds |= b.surfaceV.plan->needs();
        for (const LightOutput& o : b.lightOutputs) {
            if (o.S.bound) b.pointNeeds |= o.S.bound.plan->needs();
            if (o.V.bound) b.pointNeeds |= o.V.bound.plan->needs();
        }
        if (b.areaLight < 0) continue;
        const BoundLight& light = lights_[size_t(b.areaLight)];
        b.pointNeeds |= light.pointNeeds;
    }
}

} // namespace alpenglow::world

// Whether a frame traces camera rays only. Then geometry that they cannot reach may be left out.
#include "scene/scene.h"
#include "world/mutableworld.h"
#include "world/service.h"

namespace alpenglow::world {

namespace {

/// Whether a call needs neither rays nor points of complete surfaces. Unlisted calls may need them.
bool sendsNothing(const SiteInfo& s) {
    if (s.service) return (s.service->traits & kSendsNothing) && s.sentStrings.empty(); // sent strings make kernels later
    switch (s.kind) {
    case SiteKind::Ambient:
    case SiteKind::Diffuse:
    case SiteKind::Specular:
    case SiteKind::Phong:
    case SiteKind::Illuminance:
    case SiteKind::Printf:
    case SiteKind::Text:
        return s.sentStrings.empty();
    default:
        return false;
    }
}

bool sendsNothing(const BoundKernel& k) {
    return std::all_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) { return sendsNothing(s); });
}

bool sendsNothing(const Opacity& o) { return sendsNothing(o.kernel); }

} // namespace

bool MutableWorld::onlyCameraRays() const {
    if (settings_.hider == Hider::Path || !media_.empty() || deferred_ || globalMaps_ || needs_.bakes || needs_.records ||
        settings_.bsdfOnly || settings_.lightOnly)
        return false;
    for (const BoundLight& l : lights_) {
        // An area light with a mean needs no rays; any other with an extent does.
        if (l.shadows || !sendsNothing(l.kernel) || (l.kind == LightKind::Area && !l.mean) || l.kind == LightKind::Environment)
            return false;
        for (const auto& [key, kernel] : l.variants)
            if (!sendsNothing(kernel)) return false;
    }
    for (const SurfaceBinding& b : bindings_) {
        for (const BoundKernel* k : {&b.surfaceS, &b.surfaceV, &b.displacementS, &b.moveS, &b.entering, &b.atmosphere.kernel})
            if (!sendsNothing(*k)) return false;
        if (!sendsNothing(b.opacity) || !sendsNothing(b.primitiveOpacity) || !sendsNothing(b.shaderOpacity)) return false;
        for (const LightOutput& o : b.lightOutputs)
            if (!sendsNothing(o.S.bound) || !sendsNothing(o.V.bound)) return false;
    }
    return true;
}

} // namespace alpenglow::world

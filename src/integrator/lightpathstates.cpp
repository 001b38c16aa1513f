// Events of light paths, from the camera on, for the light path outputs (scene/lightpaths.h).
#include "integrator/lightpathstates.h"
#include "integrator/context.h"
#include "integrator/stageset.h"

namespace alpenglow::integrator {

namespace {
/// Name of a light in expressions, besides its handle: Attribute "light" "group", else parameter "__group" of its shader.
std::string groupOf(const BoundLight& l) {
    if (l.source && l.source->attributes)
        if (const scene::Param* p = l.source->attributes->value("light:group"); p && !p->strings.empty()) return p->strings[0];
    if (!l.instance) return {};
    const auto i = l.instance->parameters.strings.find(rsl::kGroup);
    return i == l.instance->parameters.strings.end() ? std::string() : i->second;
}

/// Whether w leaves a surface on the side of the ray. The sides of w are those of the shading normal, around which lobes lie.
bool reflects(const PathRay& ray, const ShadePoint& p, const Vec3& w) {
    const float side = dot(w, p.N) * (dot(p.N, p.surface.n) < 0 ? -1.f : 1.f);
    return (dot(ray.dir, p.surface.n) < 0) == (side > 0);
}
} // namespace

int LightPathStates::labelOf(const std::string& name) const { return name.empty() ? -1 : automaton->label(name); }

LightPathStates::LightPathStates(const StageSet& s) : Stage(s.context) {
    const Settings& set = world_.settings();
    if (set.hider != Hider::Path || !set.lightPaths) return;
    using enum scene::PathEvent;
    automaton = set.lightPaths.get();
    for (const BoundLight& l : world_.lights()) {
        const bool sky = l.kind == LightKind::Environment || l.kind == LightKind::Ambient;
        lights.push_back(automaton->symbol(sky ? Sky : Light, scene::PathScattering::None, labelOf(groupOf(l)),
                                           labelOf(l.source ? l.source->handle : l.handle)));
    }
    straight = automaton->symbol(Transmission, scene::PathScattering::Straight);
    mirror = automaton->symbol(Reflection, scene::PathScattering::Singular);
    volume = automaton->symbol(Volume);
    object = automaton->symbol(Object);
    map = automaton->symbol(Sky);
    loopLight = automaton->symbol(Light);
    loopLabel = labelOf("illuminance");
    ambientLabel = labelOf("ambient");
}

uint16_t LightPathStates::atLobe(const LobeKind& kind, const RayKind& rays, bool delta, const ShadePoint& p, const PathRay& ray,
                                 const Vec3& w) const {
    if (ray.path == 0) return 0;
    if (p.surface.n == Vec3(0)) return next(ray.path, volume); // a medium has no sides
    using scene::PathScattering;
    const PathScattering how = delta                           ? PathScattering::Singular
                               : rays.type == RayType::Diffuse ? PathScattering::Diffuse
                                                               : PathScattering::Glossy;
    int ofRays = -1, ofLobe = -1;
    if (automaton->hasLabels()) {
        auto known = labelOfLobe_.find(&kind);
        if (known == labelOfLobe_.end()) known = labelOfLobe_.emplace(&kind, labelOf(std::string(kind.name))).first;
        ofLobe = known->second;
        if (rays.label) {
            auto label = labelOfRays_.find(rays.label);
            if (label == labelOfRays_.end())
                label = labelOfRays_.emplace(rays.label, labelOf(rsl::internedString(rays.label))).first;
            ofRays = label->second;
        }
    }
    const auto event = reflects(ray, p, w) ? scene::PathEvent::Reflection : scene::PathEvent::Transmission;
    return next(ray.path, automaton->symbol(event, how, ofRays, ofLobe));
}

uint16_t LightPathStates::atLoop(const ShadePoint& p, const PathRay& ray, const Vec3& w, int label) const {
    if (ray.path == 0) return 0;
    const auto event = reflects(ray, p, w) ? scene::PathEvent::Reflection : scene::PathEvent::Transmission;
    return next(ray.path, automaton->symbol(event, scene::PathScattering::Diffuse, label));
}

} // namespace alpenglow::integrator

// Which lights get a sample at a vertex. With few, each does; with more than limits::kLightsSampled about that many, by LightChooser.
// What a chosen light gives is divided by the probability of the choice: the mean stays the same.
#include "transport/engine.h"

namespace alpenglow::transport {

void WorldImpl::makeChoosers() {
    choosers_.resize(sampledLights_.size());
    for (size_t list = 0; list < sampledLights_.size(); ++list) {
        const std::vector<int>& lights = sampledLights_[list];
        if (lights.size() <= size_t(limits::kLightsSampled)) continue;
        std::vector<LightBound> bounds;
        for (int i : lights) {
            const BoundLight& l = lights_[size_t(i)];
            bounds.push_back({l.centre, l.radius, l.power, l.kind == LightKind::Distant});
        }
        choosers_[list].chooser = LightChooser(bounds, limits::kLightsSampled);
        choosers_[list].numberOf.assign(lights_.size(), -1);
        for (size_t i = 0; i < lights.size(); ++i) choosers_[list].numberOf[size_t(lights[i])] = int(i);
    }
}

float Engine::chanceOf(int light, int binding, const Vec3& at) const {
    const WorldImpl::ChooserOfList& of = world_->choosers_[size_t(world_->bindings_[size_t(binding)].lightList)];
    return of.chooser.empty() ? 1 : of.chooser.pmf(of.numberOf[size_t(light)], at);
}

} // namespace alpenglow::transport

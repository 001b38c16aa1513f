// Which lights get a sample at a vertex. With few, each does; with more than limits::kLightsSampled about that many, by
// LightChooser. What a chosen light gives is divided by the probability of the choice: the mean stays the same.
#include "world/impl.h"

namespace alpenglow::transport {

namespace {
/// Whether the light's kernel needs nothing but its parameters and the point: then lights may share a call.
bool sharesCalls(const BoundLight& l, bool media) {
    if (!l.kernel || l.kernel.kernel->facts().suspends || l.asksSurface || l.channels || l.sentCl >= 0) return false;
    if (l.kind == LightKind::Area && (l.hazy || media)) return false;
    return std::all_of(l.kernel.sites.begin(), l.kernel.sites.end(), [](const SiteInfo& s) {
        return s.kind == SiteKind::Texture || s.kind == SiteKind::Environment || s.kind == SiteKind::TextureInfo;
    });
}

/// Whether a kernel asks for light over lobes, which sample lights.
bool hasLobes(const BoundKernel& k) {
    return std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) { return s.lobe != nullptr; });
}

bool hasLobes(const SurfaceBinding& b) {
    const auto ofOutput = [](const LightOutput& o) { return hasLobes(o.S.bound) || hasLobes(o.V.bound); };
    return hasLobes(b.surfaceS) || hasLobes(b.surfaceV) || hasLobes(b.displacementS) || hasLobes(b.moveS) ||
           hasLobes(b.atmosphere.kernel) || std::any_of(b.lightOutputs.begin(), b.lightOutputs.end(), ofOutput);
}
} // namespace

void WorldImpl::groupLights(Diagnostics& d) {
    std::map<std::tuple<const rsl::CompiledKernel*, int, LightKind>, size_t> known; // one block of one program
    std::vector<std::vector<int>> like; // in the order of their first lights: that of pointers differs from run to run
    for (size_t i = 0; i < lights_.size(); ++i)
        if (const BoundLight& l = lights_[i]; sharesCalls(l, !media_.empty())) {
            const auto [at, fresh] = known.try_emplace({l.kernel.kernel.get(), l.outCl, l.kind}, like.size());
            if (fresh) like.emplace_back();
            like[at->second].push_back(int(i));
        }
    for (const std::vector<int>& lights : like) {
        if (lights.size() < 2) continue;
        const BoundLight& first = lights_[size_t(lights[0])];
        std::vector<std::string> outputs;
        for (const auto& o : first.kernel.kernel->outputs()) outputs.push_back(o.name);
        BoundKernel k = kernel(*first.instance, outputs, {}, true, false, d);
        if (!k || k.kernel->outputs().size() != outputs.size()) continue;
        for (int i : lights) {
            BoundLight& l = lights_[size_t(i)];
            l.group = int(lightGroups_.size());
            l.rows = std::make_shared<shading::ParameterRows>(*k.plan, l.instance->parameters);
        }
        lightGroups_.push_back({std::move(k)});
    }
}

void WorldImpl::makeChoosers(Diagnostics& d) {
    choosers_.resize(sampledLights_.size());
    // Every emitter of a scene may have a list of its own, with all lights that came before it: a tree is made where lobes ask.
    std::vector<char> asks(sampledLights_.size(), hasLobes(primitiveHit_));
    for (const SurfaceBinding& b : bindings_)
        if (hasLobes(b)) asks[size_t(b.lightList)] = 1;
    for (size_t list = 0; list < sampledLights_.size(); ++list) {
        const std::vector<int>& lights = sampledLights_[list];
        if (!asks[list] || lights.size() <= size_t(limits::kLightsSampled)) continue;
        std::vector<LightBound> bounds;
        for (int i : lights) {
            const BoundLight& l = lights_[size_t(i)];
            bounds.push_back({l.centre, l.radius, l.power, l.kind == LightKind::Distant});
        }
        choosers_[list].chooser = LightChooser(bounds, limits::kLightsSampled);
        choosers_[list].numberOf.assign(lights_.size(), -1);
        for (size_t i = 0; i < lights.size(); ++i) choosers_[list].numberOf[size_t(lights[i])] = int(i);
    }
    const bool many = std::any_of(choosers_.begin(), choosers_.end(), [](const ChooserOfList& c) { return !c.chooser.empty(); });
    if (many && settings_.hider == Hider::Path) groupLights(d);
}

} // namespace alpenglow::transport

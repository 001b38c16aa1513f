// Which lights are sampled at a vertex. Up to limits::kLightsSampled lights: all. Otherwise LightChooser chooses about that many
// at the first vertex of a path, and limits::kLightsSampledDeeper at later ones. Contributions are divided by the probability of
// the choice, so the mean is unchanged.
#include "world/mutableworld.h"

namespace alpenglow::world {

namespace {
/// Whether the light's kernel needs only its parameters and the point, so that lights may share a call.
bool sharesCalls(const BoundLight& l, bool media) {
    if (!l.kernel || l.kernel.kernel->facts().suspends || l.asksSurface || l.channels || l.sentCl >= 0) return false;
    if (l.kind == LightKind::Area && (l.inAtmosphere || media)) return false;
    return std::all_of(l.kernel.sites.begin(), l.kernel.sites.end(), [](const SiteInfo& s) {
        return s.kind == SiteKind::Texture || s.kind == SiteKind::Environment || s.kind == SiteKind::Shadow ||
               s.kind == SiteKind::TextureInfo;
    });
}

/// Whether a kernel requests lobes that sample lights.
bool hasLobes(const BoundKernel& k) {
    return std::any_of(k.sites.begin(), k.sites.end(), [](const SiteInfo& s) { return s.lobe != nullptr; });
}

bool hasLobes(const SurfaceBinding& b) {
    const auto ofOutput = [](const LightOutput& o) { return hasLobes(o.S.bound) || hasLobes(o.V.bound); };
    return hasLobes(b.surfaceS) || hasLobes(b.surfaceV) || hasLobes(b.displacementS) || hasLobes(b.moveS) ||
           hasLobes(b.atmosphere.kernel) || std::any_of(b.lightOutputs.begin(), b.lightOutputs.end(), ofOutput);
}
} // namespace

void MutableWorld::groupLights(Diagnostics& d) {
    std::map<std::tuple<const rsl::CompiledKernel*, int, LightKind>, size_t> known; // one block of one program
    std::vector<std::vector<int>> like; // in order of first lights: the order of pointers differs from run to run
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

bool MutableWorld::getsSamples(const BoundLight& l) const {
    if (!l.kernel) return false;
    return l.kind == LightKind::Point || l.kind == LightKind::Distant || l.sky ||
           (l.kind == LightKind::Area && !l.emitter->empty());
}

void MutableWorld::makeChoosers(Diagnostics& d) {
    // Every emitter of a scene may have a list of its own, of all lights before it: trees are built only for lists with lobes.
    std::vector<char> asks(lightLists_.size(), hasLobes(primitiveHit_));
    for (const SurfaceBinding& b : bindings_)
        if (hasLobes(b)) asks[size_t(b.lightList)] = 1;
    for (const Medium& m : media_)
        if (m.homogeneous) asks[size_t(bindings_[size_t(m.binding)].lightList)] = 1;
    const auto chooserOver = [&](const std::vector<int>& lights, int wanted) {
        std::vector<LightBound> bounds;
        for (int i : lights) {
            const BoundLight& l = lights_[size_t(i)];
            bounds.push_back({l.centre, l.radius, settings_.evenLights ? 0 : l.power,
                              l.kind == LightKind::Distant || l.kind == LightKind::Environment,
                              settings_.evenLights ? Cone() : l.front});
        }
        return LightChooser(bounds, wanted);
    };
    // Noise shows at the first vertex of a path; fewer samples suffice at later ones (docs/noise.md). In media all vertices use
    // the same chooser.
    const int deeper = media_.empty() ? limits::kLightsSampledDeeper : limits::kLightsSampled;
    bool many = false;
    for (size_t i = 0; i < lightLists_.size(); ++i)
        if (LightList& list = lightLists_[i]; asks[i] && !list.ofAll && list.sampled.size() > size_t(limits::kLightsSampled)) {
            list.chooser = chooserOver(list.sampled, limits::kLightsSampled);
            list.deeper = chooserOver(list.sampled, deeper);
            many = true;
        }
    if (allSampled_.size() > size_t(limits::kLightsSampled)) {
        allChooser_ = chooserOver(allSampled_, limits::kLightsSampled);
        allDeeper_ = chooserOver(allSampled_, deeper);
        many = true;
    }
    if (many && settings_.hider == Hider::Path) groupLights(d);
}

} // namespace alpenglow::world

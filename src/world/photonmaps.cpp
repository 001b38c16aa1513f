#include "world/photonmaps.h"
#include "photonmap/photonfile.h"
#include "world/causticguide.h"
#include "world/impl.h"
#include "world/procedurals.h"
#include <algorithm>
#include <set>

namespace alpenglow::world {

namespace {

/// The photon maps that the surfaces of a frame name: name, and whether it holds caustics.
std::set<std::pair<std::string, bool>> namedBySurfaces(const WorldImpl& w) {
    std::set<std::pair<std::string, bool>> names;
    for (const SurfaceBinding& b : w.bindings()) {
        if (!b.photons.globalMap.empty()) names.insert({b.photons.globalMap, false});
        if (!b.photons.causticMap.empty()) names.insert({b.photons.causticMap, true});
    }
    return names;
}

} // namespace

std::vector<std::string> photonMapsOf(const World& world, bool all) {
    const auto& w = static_cast<const WorldImpl&>(world);
    std::set<std::string> names;
    for (const auto& [name, caustic] : namedBySurfaces(w))
        if (all || (caustic ? w.photons()->asksCaustics : w.needs().globalPhotons)) names.insert(name);
    for (const auto& [name, place] : w.photons()->asked()) names.insert(name);
    if (!all) std::erase_if(names, [&](const std::string& n) { return w.photons()->has(n); });
    return {names.begin(), names.end()};
}

std::map<std::string, std::vector<photonmap::Photon>> photonsByMap(const World& world, std::span<const std::string> maps,
                                                                   std::span<const StoredPhoton> stored) {
    const auto& w = static_cast<const WorldImpl&>(world);
    std::map<std::string, std::vector<photonmap::Photon>> by;
    for (const std::string& name : maps) by[name];
    const auto named = namedBySurfaces(w);
    std::vector<std::vector<photonmap::Photon>*> ofAll; // maps that no surface names
    for (auto& [name, photons] : by)
        if (!named.count({name, false}) && !named.count({name, true})) ofAll.push_back(&photons);
    std::vector<std::vector<photonmap::Photon>*> global, caustic; // by binding
    for (const SurfaceBinding& b : w.bindings()) {
        const auto find = [&](const std::string& name) {
            const auto i = by.find(name);
            return i == by.end() ? nullptr : &i->second;
        };
        global.push_back(b.photons.globalMap.empty() ? nullptr : find(b.photons.globalMap));
        caustic.push_back(b.photons.causticMap.empty() ? nullptr : find(b.photons.causticMap));
    }
    for (const StoredPhoton& s : stored) {
        auto *const g = global[size_t(s.binding)], *const c = caustic[size_t(s.binding)];
        if (g) g->push_back(s.photon);
        if (c && c != g && s.caustic) c->push_back(s.photon); // one name for both holds all
        for (auto* m : ofAll) m->push_back(s.photon);
    }
    return by;
}

bool savePhotonMap(const World& world, const std::string& name, std::span<const photonmap::Photon> photons, uint64_t emitted,
                   bool allowWrite, Diagnostics& d) {
    const auto& w = static_cast<const WorldImpl&>(world);
    return photonmap::savePhotons(name, photons, emitted, w.cameraToWorld(), {".", allowWrite}, d);
}

bool mayHaveCaustics(const World& world) {
    const auto& w = static_cast<const WorldImpl&>(world);
    if (hasDeferred(world)) return false; // the world may be replaced while rays are traced
    const auto bakes = [](const SiteInfo& s) { return s.kind == SiteKind::Bake || s.kind == SiteKind::Bake3d; };
    for (const SurfaceBinding& b : w.bindings()) // samples that measure the brightness of the picture would be baked, too
        if (b.surfaceS && std::any_of(b.surfaceS.sites.begin(), b.surfaceS.sites.end(), bakes)) return false;
    return std::any_of(w.bindings().begin(), w.bindings().end(), [](const SurfaceBinding& b) {
        return b.surfaceS && !b.surfaceS.kernel->facts().suspends &&
               std::any_of(b.surfaceS.sites.begin(), b.surfaceS.sites.end(),
                           [](const SiteInfo& s) { return s.kind == SiteKind::Trace; });
    });
}

GuideFigures guideCaustics(const World& world, std::span<const StoredPhoton> stored, double emitted, float brightness) {
    constexpr size_t kFewest = 64;
    constexpr double kLeast = 1e-5; ///< fraction of all light
    const auto& w = static_cast<const WorldImpl&>(world);
    std::vector<GuidePhoton> photons;
    double power = 0;
    for (const StoredPhoton& s : stored) {
        const float l = luminance(s.photon.power);
        if (!s.caustic || !(l > 0)) continue;
        const int side = SurfaceTree::sideOf(photonmap::unpackUnit(s.photon.normal));
        photons.push_back({s.photon.P, s.photon.P + s.way, side, l});
        power += l;
    }
    w.photons()->guide.reset();
    if (photons.size() < kFewest || !(power > kLeast * emitted) || !(brightness > 0)) return {photons.size()};
    auto guide = std::make_shared<const CausticGuide>(photons, brightness);
    const GuideFigures figures{photons.size(), guide->cells(), guide->lobes()};
    w.photons()->guide = std::move(guide);
    return figures;
}

void setPhotonPasses(const World& world, uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>> passes) {
    static_cast<const WorldImpl&>(world).photons()->setPasses(first, std::move(passes));
}

void setPhotonMap(const World& world, const std::string& name, std::vector<photonmap::Photon> photons) {
    static_cast<const WorldImpl&>(world).photons()->set(name, std::make_shared<const photonmap::PhotonMap>(std::move(photons)));
}

} // namespace alpenglow::world

#include "integrator/photons.h"
#include "integrator/deferred.h"
#include "integrator/photonstage.h"
#include "integrator/pipeline.h"
#include "photonmap/photonfile.h"
#include "world/causticguide.h"
#include <set>

namespace alpenglow::integrator {

struct PhotonEmission::Impl {
    std::shared_ptr<const WorldImpl> world;
    std::unique_ptr<EmissionPlan> plan;
    std::vector<uint8_t> met;
    PhotonUse use;
    PhotonJob job(uint32_t pass, double emitted) const {
        PhotonJob j;
        j.plan = plan.get();
        j.met = met.data();
        j.seed = world->settings_.seed;
        j.pass = pass;
        j.caustics = use.caustics;
        j.learns = use.learns;
        j.models = !use.caustics;
        j.width = use.caustics ? use.width : 0;
        j.scale = 1 / emitted;
        return j;
    }
};

PhotonEmission::PhotonEmission(std::shared_ptr<const World> w, const PhotonUse& use, Diagnostics& d)
    : impl_(std::make_unique<Impl>()) {
    impl_->world = std::static_pointer_cast<const WorldImpl>(std::move(w));
    impl_->use = use;
    const Pipeline pipeline(impl_->world, d);
    impl_->plan = std::make_unique<EmissionPlan>(pipeline.stages().lightKernels, use.all, use.sky);
    impl_->met = impl_->plan->met(use.caustics);
}
PhotonEmission::~PhotonEmission() = default;
bool PhotonEmission::lights() const { return !impl_->plan->empty(); }
bool PhotonEmission::moves() const { return impl_->plan->moves(); }
double PhotonEmission::power() const {
    double sum = 0;
    for (const EmissionPlan::Light& l : impl_->plan->lights()) sum += l.power;
    return sum;
}
void PhotonEmission::learn(std::span<const StoredPhoton> stored, uint32_t pass, uint32_t emitted) {
    impl_->plan->learn(stored, impl_->job(pass, emitted), emitted);
}
void PhotonEmission::tellLights() const {
    impl_->world->photons_->lightsOfPasses = impl_->plan->emits();
    impl_->world->photons_->widthOfPasses = impl_->use.width;
}

struct PhotonEmission::Thread::Impl {
    const PhotonEmission::Impl& of;
    Pipeline pipeline;
    Impl(const PhotonEmission::Impl& i, Diagnostics& d) : of(i), pipeline(i.world, d) {}
};
PhotonEmission::Thread::Thread(const PhotonEmission& e, Diagnostics& d) : impl_(std::make_unique<Impl>(*e.impl_, d)) {}
PhotonEmission::Thread::~Thread() = default;
bool PhotonEmission::Thread::emit(uint32_t pass, uint32_t first, uint32_t count, double emitted, std::vector<StoredPhoton>& out,
                                  const StopFlag* stop) {
    return impl_->pipeline.emit(impl_->of.job(pass, emitted), first, count, out, stop);
}
float PhotonEmission::Thread::travel() const {
    const PhotonTrace* t = impl_->pipeline.stages().photons.photonTrace();
    return std::max(t ? t->fastest : 0, impl_->of.plan->travel());
}
const Counters& PhotonEmission::Thread::counters() const { return impl_->pipeline.counters(); }

namespace {

/// The photon maps that the surfaces of a frame name: name, and whether it holds caustics.
std::set<std::pair<std::string, bool>> namedBySurfaces(const WorldImpl& w) {
    std::set<std::pair<std::string, bool>> names;
    for (const SurfaceBinding& b : w.bindings_) {
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
        if (all || (caustic ? w.photons_->asksCaustics : w.needs_.globalPhotons)) names.insert(name);
    for (const auto& [name, place] : w.photons_->asked()) names.insert(name);
    if (!all) std::erase_if(names, [&](const std::string& n) { return w.photons_->has(n); });
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
    for (const SurfaceBinding& b : w.bindings_) {
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
    return photonmap::savePhotons(name, photons, emitted, w.cameraToWorld_, {".", allowWrite}, d);
}

bool mayHaveCaustics(const World& world) {
    const auto& w = static_cast<const WorldImpl&>(world);
    if (hasDeferred(world)) return false; // the world may be replaced while rays are traced
    const auto bakes = [](const SiteInfo& s) { return s.kind == SiteKind::Bake || s.kind == SiteKind::Bake3d; };
    for (const SurfaceBinding& b : w.bindings_) // samples that measure the brightness of the picture would be baked, too
        if (b.surfaceS && std::any_of(b.surfaceS.sites.begin(), b.surfaceS.sites.end(), bakes)) return false;
    return std::any_of(w.bindings_.begin(), w.bindings_.end(), [](const SurfaceBinding& b) {
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
    w.photons_->guide.reset();
    if (photons.size() < kFewest || !(power > kLeast * emitted) || !(brightness > 0)) return {photons.size()};
    auto guide = std::make_shared<const CausticGuide>(photons, brightness);
    const GuideFigures figures{photons.size(), guide->cells(), guide->lobes()};
    w.photons_->guide = std::move(guide);
    return figures;
}

void setPhotonPasses(const World& world, uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>> passes) {
    static_cast<const WorldImpl&>(world).photons_->setPasses(first, std::move(passes));
}

void setPhotonMap(const World& world, const std::string& name, std::vector<photonmap::Photon> photons) {
    static_cast<const WorldImpl&>(world).photons_->set(name, std::make_shared<const photonmap::PhotonMap>(std::move(photons)));
}

} // namespace alpenglow::integrator

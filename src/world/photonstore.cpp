#include "world/photonstore.h"
#include "photonmap/photonfile.h"

namespace alpenglow::world {

namespace {

constexpr MapKind kKind{"photon map", "lookups return no light",
                        "Hider \"photon\" writes it; rendering makes it if lights have Attribute \"light\" \"int emitphotons\" 1",
                        false};

} // namespace

void PhotonStore::asks(const std::string& name, const SourcePlace& place) {
    if (!name.empty()) asked_.try_emplace(name, place);
}

bool PhotonStore::has(const std::string& name) const {
    std::string outside;
    return maps_.count(name) > 0 || lookUpMap(name, files_, kKind, &outside);
}

const photonmap::PhotonMap* PhotonStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = maps_.try_emplace(name);
    if (!fresh) return at->second.get();
    if (const auto path = findMap(name, files_, kKind, diagnostics_, place))
        at->second = photonmap::loadPhotons(*path, worldToCamera_, diagnostics_, place);
    return at->second.get();
}

void PhotonStore::set(const std::string& name, std::shared_ptr<const photonmap::PhotonMap> map) {
    std::lock_guard lock(mutex_);
    maps_[name] = std::move(map);
}

void PhotonStore::setPasses(uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>> passes) {
    firstPass_ = first;
    passes_ = std::move(passes);
}

} // namespace alpenglow::world

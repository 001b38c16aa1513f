#include "world/photonstore.h"
#include "photons/photonfile.h"

namespace alpenglow::transport {

void PhotonStore::asks(const std::string& name, const SourcePlace& place) {
    if (!name.empty()) asked_.try_emplace(name, place);
}

std::string PhotonStore::fileOf(const std::string& name, std::string* outside) const {
    std::vector<std::string> folders = {""};
    folders.insert(folders.end(), files_.folders.begin(), files_.folders.end());
    const auto found = findFile(name, folders, files_.read, outside);
    return found && !found->baseNameOnly ? found->path : "";
}

bool PhotonStore::has(const std::string& name) const {
    std::string outside;
    return maps_.count(name) > 0 || !fileOf(name, &outside).empty();
}

const photons::PhotonMap* PhotonStore::find(const std::string& name, const SourcePlace& place) {
    if (name.empty()) return nullptr;
    std::lock_guard lock(mutex_);
    const auto [at, fresh] = maps_.try_emplace(name);
    if (!fresh) return at->second.get();
    std::string outside;
    if (const std::string path = fileOf(name, &outside); !path.empty())
        at->second = photons::loadPhotons(path, files_.worldToCamera, diagnostics_, place);
    else if (!outside.empty())
        diagnostics_.report(outsideMessage("photon map", name, outside, place));
    else
        diagnostics_.report(Severity::Error, Rie::NoFile, place, "there is no photon map \"" + name + "\"; it gives no light",
                            "Hider \"photon\" makes it, and so does rendering where lights have Attribute \"light\" "
                            "\"int emitphotons\" 1");
    return at->second.get();
}

void PhotonStore::set(const std::string& name, std::shared_ptr<const photons::PhotonMap> map) {
    std::lock_guard lock(mutex_);
    maps_[name] = std::move(map);
}

void PhotonStore::setPasses(uint32_t first, std::vector<std::unique_ptr<photons::PhotonGrid>> passes) {
    firstPass_ = first;
    passes_ = std::move(passes);
}

} // namespace alpenglow::transport

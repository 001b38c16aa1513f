// The photon maps that a frame's shaders ask for, and the photons of progressive passes.
#pragma once
#include "base/matrix.h"
#include "photons/photongrid.h"
#include "photons/photonmap.h"
#include "world/mapfiles.h"
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace alpenglow::transport {

class CausticGuide;

class PhotonStore {
public:
    /// Photons come from files in the space of the world; `worldToCamera` takes them to that of rays.
    PhotonStore(MapFiles files, const Matrix& worldToCamera, Diagnostics& d)
        : files_(std::move(files)), worldToCamera_(worldToCamera), diagnostics_(d) {}

    // While a world is made: what its shaders ask for.
    /// A photonmap() of this name; where the call stands.
    void asks(const std::string& name, const SourcePlace&);
    /// Some caustic(), some indirectdiffuse(): the maps of the surfaces' attributes are asked for.
    bool asksCaustics = false, asksGlobal = false;
    /// Names that the shaders ask for by themselves.
    const std::map<std::string, SourcePlace>& asked() const { return asked_; }

    /// The map of a name, from set(), or else from a file that is read when it is first asked for. Null: there is none, which was
    /// reported once. Thread safe; the map lives as long as the store.
    const photons::PhotonMap* find(const std::string& name, const SourcePlace&);
    /// Whether there is such a file or map; reads nothing.
    bool has(const std::string& name) const;
    /// A map that was made for this frame. Nobody looks maps up meanwhile.
    void set(const std::string& name, std::shared_ptr<const photons::PhotonMap>);

    /// The photons of one sample of every pixel; null: none. Passes change while nobody follows rays.
    const photons::PhotonGrid* pass(uint32_t sample) const {
        return sample - firstPass_ < passes_.size() ? passes_[sample - firstPass_].get() : nullptr;
    }
    /// Passes for samples from `first` on, in the place of those before. lights: by light, whether its photons are in them.
    void setPasses(uint32_t first, std::vector<std::unique_ptr<photons::PhotonGrid>> passes);
    std::vector<uint8_t> lightsOfPasses;
    /// Null: paths find caustics by chance alone. Changes while nobody follows rays.
    std::shared_ptr<const CausticGuide> guide;
    float widthOfPasses = 0; ///< photons follow lobes whose spread is below, in radians, as they do mirrors

private:
    MapFiles files_;
    Matrix worldToCamera_;
    Diagnostics& diagnostics_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const photons::PhotonMap>> maps_; ///< null: none
    std::map<std::string, SourcePlace> asked_;
    uint32_t firstPass_ = 0;
    std::vector<std::unique_ptr<photons::PhotonGrid>> passes_;
};

} // namespace alpenglow::transport

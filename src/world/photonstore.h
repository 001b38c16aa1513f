// Photon maps that the shaders of a frame read, and the photons of progressive passes.
#pragma once
#include "base/matrix.h"
#include "photonmap/photongrid.h"
#include "photonmap/photonmap.h"
#include "world/mapfiles.h"
#include <map>
#include <mutex>
#include <set>
#include <string>

namespace alpenglow::world {

class CausticGuide;
class CausticSeeds;
class LightGuide;

/// The photon maps of one world. Looked up by any thread; changed between passes only.
class PhotonStore {
public:
    /// Photons in files are in world space; `worldToCamera` converts them to the space of rays.
    PhotonStore(MapFiles files, const Matrix& worldToCamera, Diagnostics& d)
        : files_(std::move(files)), worldToCamera_(worldToCamera), diagnostics_(d) {}

    // While a world is built: the maps that its shaders read.
    /// Registers a photonmap() of this name, with the place of the call.
    void asks(const std::string& name, const SourcePlace&);
    /// A caustic() or indirectdiffuse() call needs the maps named by surface attributes.
    bool asksCaustics = false;
    /// Names that shaders give themselves.
    const std::map<std::string, SourcePlace>& asked() const { return asked_; }

    /// The map of a name: from set(), or from a file that is read at first use. Returns null if it does not exist, which is
    /// reported once. Thread safe; the map lives as long as the store.
    const photonmap::PhotonMap* find(const std::string& name, const SourcePlace&);
    /// Whether such a file or map exists; reads nothing.
    bool has(const std::string& name) const;
    /// Adds a map made for this frame. Call while no thread looks maps up.
    void set(const std::string& name, std::shared_ptr<const photonmap::PhotonMap>);

    /// The photons for one sample of every pixel; null: none. Passes change only while no thread traces.
    const photonmap::PhotonGrid* pass(uint32_t sample) const {
        return sample - firstPass_ < passes_.size() ? passes_[sample - firstPass_].get() : nullptr;
    }
    bool hasPasses() const { return !passes_.empty(); }
    /// Sets the passes for samples from `first` on and removes earlier ones. lights: by light, whether the passes contain its
    /// photons.
    void setPasses(uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>> passes);
    std::vector<uint8_t> lightsOfPasses;
    /// Null: paths find caustics by chance only. Changes only while no thread traces.
    std::shared_ptr<const CausticGuide> guide;
    /// Null: no light of point, spot and distant lights comes by mirrors and glass. Changes only while no thread traces.
    std::shared_ptr<const CausticSeeds> seeds;
    /// By light: guides of its samples (world/lightguide.h); empty: no light has one. Changes only while no thread traces.
    std::vector<std::shared_ptr<const LightGuide>> lightGuides;
    /// Light samples that would bring less luminance than this to a pixel are subject to Russian roulette (ShadowRays); 0: none.
    /// Changes only while no thread traces.
    float leastLight = 0;
    float widthOfPasses = 0; ///< photons treat lobes with a smaller spread, in radians, as mirrors

private:
    MapFiles files_;
    Matrix worldToCamera_;
    Diagnostics& diagnostics_;
    std::mutex mutex_;
    std::map<std::string, std::shared_ptr<const photonmap::PhotonMap>> maps_; ///< null: does not exist
    std::map<std::string, SourcePlace> asked_;
    uint32_t firstPass_ = 0;
    std::vector<std::unique_ptr<photonmap::PhotonGrid>> passes_;
};

} // namespace alpenglow::world

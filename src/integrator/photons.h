// Emitting photons over a world, and the photon maps that its frame asks for.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "integrator/samples.h"
#include "integrator/storedphoton.h"
#include "photons/photongrid.h"
#include "world/world.h"
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::transport {

/// What an emission is for.
struct PhotonUse {
    bool all = true;       ///< lights that say nothing about photons emit, where none says that it does
    bool sky = true;       ///< environments, too
    bool caustics = false; ///< only what mirrors and glass send is wanted
    float width = 0;       ///< and lobes whose spread is below, in radians
    bool learns = false;   ///< for the caustic guide: shaders print and bake nothing, and no message is reported
};

/// How photons of one world are emitted. The world must have been made for the hider path.
class PhotonEmission {
public:
    PhotonEmission(std::shared_ptr<const World>, const PhotonUse&, Diagnostics&);
    ~PhotonEmission();
    bool lights() const;  ///< whether some light emits
    bool moves() const;   ///< whether anything moves that photons may meet or come from
    double power() const; ///< of them all, luminance, about
    /// From now on more photons are sent where those went that came to rest, of `emitted` of a pass. Nobody emits meanwhile.
    void learn(std::span<const StoredPhoton>, uint32_t pass, uint32_t emitted);
    /// The world's light of passes is that of the lights that emit here.
    void tellLights() const;

    /// What emits on one thread.
    class Thread {
    public:
        Thread(const PhotonEmission&, Diagnostics&);
        ~Thread();
        /// Photons `first` to first + count - 1 of a pass, of which `emitted` are emitted altogether: those that came to rest are
        /// added to `out`, in the order of their numbers. False: stopped; `out` is void.
        bool emit(uint32_t pass, uint32_t first, uint32_t count, double emitted, std::vector<StoredPhoton>& out,
                  const StopFlag* stop);
        const Counters& counters() const;
        /// How far lights, and the surfaces that its photons have met, move while the shutter is open.
        float travel() const;

    private:
        struct Impl;
        std::unique_ptr<Impl> impl_;
    };

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The names of the photon maps of a frame: `all` that its surfaces and shaders name, or else those that its shaders ask for and
/// that are not there.
std::vector<std::string> photonMapsOf(const World&, bool all);

/// Photons by the maps that they belong to: those of surfaces that name the map; of a map that no surface names, all.
std::map<std::string, std::vector<photons::Photon>> photonsByMap(const World&, std::span<const std::string> maps,
                                                                 std::span<const StoredPhoton>);

/// Writes a map. False: an error was reported.
bool savePhotonMap(const World&, const std::string& name, std::span<const photons::Photon>, uint64_t emitted, bool allowWrite,
                   Diagnostics&);
/// Shaders of this world find photons under this name.
void setPhotonMap(const World&, const std::string& name, std::vector<photons::Photon>);
/// Whether light may come to surfaces by way of mirrors or clear glass, so that photons could find some.
bool mayHaveCaustics(const World&);
/// How a world's paths are guided (world/causticguide.h).
struct GuideFigures {
    uint64_t photons = 0; ///< of mirrors and glass that came to rest
    uint64_t cells = 0, lobes = 0;
};
/// From now on paths send rays where these photons of mirrors and clear glass came from. emitted: luminance of all light that was
/// emitted; brightness: mean luminance of the picture. They are not guided where such light is little. Nobody follows rays
/// meanwhile.
GuideFigures guideCaustics(const World&, std::span<const StoredPhoton>, double emitted, float brightness);
/// Photons of samples from `first` on, in the place of those before. Nobody follows rays meanwhile.
void setPhotonPasses(const World&, uint32_t first, std::vector<std::unique_ptr<photons::PhotonGrid>>);

} // namespace alpenglow::transport

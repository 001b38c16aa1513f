// Photon emission over a world, and the photon maps of its frame.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "integrator/samples.h"
#include "integrator/storedphoton.h"
#include "photonmap/photongrid.h"
#include "world/world.h"
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::integrator {

/// Purpose of an emission.
struct PhotonUse {
    bool all = true;       ///< if no light sets "emitphotons", all lights emit
    bool sky = true;       ///< environments emit, too
    bool caustics = false; ///< stores caustic photons only
    float width = 0;       ///< lobes with a smaller spread, in radians, count as mirrors
    bool learns = false;   ///< for the caustic guide: shaders do not print or bake, and messages are dropped
};

/// Emits photons in one world, which must have been built for the hider path.
class PhotonEmission {
public:
    PhotonEmission(std::shared_ptr<const World>, const PhotonUse&, Diagnostics&);
    ~PhotonEmission();
    bool lights() const;  ///< whether any light emits
    bool moves() const;   ///< whether anything moves that photons may hit or leave
    double power() const; ///< total luminance, approximate
    /// Adapts emission to the stored photons of a pass of `emitted` photons: later passes send more where these went. Call while
    /// no thread emits.
    void learn(std::span<const StoredPhoton>, uint32_t pass, uint32_t emitted);
    /// Marks the lights that emit here as those whose light the photon passes carry.
    void tellLights() const;

    /// The emitter of one thread.
    class Thread {
    public:
        Thread(const PhotonEmission&, Diagnostics&);
        ~Thread();
        /// Emits photons `first` to first + count - 1 of a pass of `emitted` photons and appends the stored ones to `out`, in the
        /// order of their numbers. Returns false if stopped; `out` is then undefined.
        bool emit(uint32_t pass, uint32_t first, uint32_t count, double emitted, std::vector<StoredPhoton>& out,
                  const StopFlag* stop);
        const Counters& counters() const;
        /// Distance that lights, and surfaces hit by its photons, move while the shutter is open.
        float travel() const;

    private:
        struct Impl;
        std::unique_ptr<Impl> impl_;
    };

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Names of the photon maps of a frame. all: every map that surfaces and shaders name; else only those that shaders read and that
/// do not exist yet.
std::vector<std::string> photonMapsOf(const World&, bool all);

/// Sorts photons by map: those of surfaces that name the map; for a map that no surface names, all photons.
std::map<std::string, std::vector<photonmap::Photon>> photonsByMap(const World&, std::span<const std::string> maps,
                                                                   std::span<const StoredPhoton>);

/// Writes a map to a file. Returns false after an error, which is reported.
bool savePhotonMap(const World&, const std::string& name, std::span<const photonmap::Photon>, uint64_t emitted, bool allowWrite,
                   Diagnostics&);
/// Makes photons available to the shaders of this world under this name.
void setPhotonMap(const World&, const std::string& name, std::vector<photonmap::Photon>);
/// Whether mirrors or clear glass may cause caustics in this world.
bool mayHaveCaustics(const World&);
/// Size of the caustic guide of a world (world/causticguide.h).
struct GuideFigures {
    uint64_t photons = 0; ///< stored caustic photons
    uint64_t cells = 0, lobes = 0;
};
/// Builds the caustic guide from photons of mirrors and clear glass; paths use it from now on. emitted: luminance of all emitted
/// light; brightness: mean luminance of the picture. No guide is built if caustics contribute little. Call while no thread
/// traces.
GuideFigures guideCaustics(const World&, std::span<const StoredPhoton>, double emitted, float brightness);
/// Sets the photons of the samples from `first` on and removes earlier ones. Call while no thread traces.
void setPhotonPasses(const World&, uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>>);

} // namespace alpenglow::integrator

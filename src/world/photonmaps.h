// The photons of a frame: the maps that its surfaces and shaders name, photons of samples, and the caustic guide.
#pragma once
#include "base/diagnostics.h"
#include "photonmap/photongrid.h"
#include "world/storedphoton.h"
#include "world/world.h"
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alpenglow::world {

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
    uint64_t photons = 0;          ///< stored caustic photons
    uint64_t cells = 0, lobes = 0; ///< sizes of the guide
};
/// Builds the caustic guide from photons of mirrors and clear glass; paths use it from now on. emitted: luminance of all emitted
/// light; brightness: mean luminance of the picture. No guide is built if caustics contribute little. Call while no thread
/// traces.
GuideFigures guideCaustics(const World&, std::span<const StoredPhoton>, double emitted, float brightness);
/// Sets the photons of the samples from `first` on and removes earlier ones. Call while no thread traces.
void setPhotonPasses(const World&, uint32_t first, std::vector<std::unique_ptr<photonmap::PhotonGrid>>);

} // namespace alpenglow::world

// Photon passes of a frame: maps to write or for its shaders, and caustics under path. Internal to render/.
#pragma once
#include "integrator/integrator.h"
#include "render/rendering.h"
#include <functional>

namespace alpenglow::render {

/// Emits photons on the threads of a job and shows progress.
class PhotonPasses {
public:
    /// use: which photons, how many.
    PhotonPasses(Job&, std::shared_ptr<const world::World>, const integrator::PhotonUse&);
    /// The same with other diagnostics.
    PhotonPasses(Job&, std::shared_ptr<const world::World>, const integrator::PhotonUse&, Diagnostics&);
    /// What emits the photons.
    integrator::PhotonEmission& emission() { return emission_; }
    /// Emits `count` photons of a pass and collects the stored ones. Returns false if stopped, or if more than limits::kPhotons
    /// were stored, which is reported; *emitted is then the number of photons emitted for these.
    bool emit(uint32_t pass, uint64_t count, std::vector<world::StoredPhoton>& stored, const std::string& what,
              uint64_t* emitted);
    /// Emits passes first to first + passes - 1 independently: take(pass, stored) receives the stored photons of `count` emitted
    /// ones, pass by pass. A pass ends when more than `most` are stored, which is reported once; these then carry the light of
    /// all. Returns false if stopped.
    bool emit(uint32_t first, uint32_t passes, uint32_t count, size_t most,
              const std::function<void(uint32_t pass, std::vector<world::StoredPhoton>)>& take);
    /// Distance that lights, and surfaces hit by photons so far, move while the shutter is open.
    float travel() const;

private:
    bool emitBlocks(uint32_t first, uint32_t count, size_t begin, size_t end, std::vector<std::vector<world::StoredPhoton>>& of);
    integrator::PhotonEmission::Thread& thread(int worker);
    Job& job_;
    Diagnostics& diagnostics_;
    integrator::PhotonEmission emission_;
    std::vector<std::unique_ptr<integrator::PhotonEmission::Thread>> threads_; ///< by worker
};

/// Number of photons by Hider or Option "photon" "emit", at most limits::kPhotonsEmitted; larger numbers are reported.
uint64_t photonsToEmit(const scene::Options&, Diagnostics&);

/// Caustics under path by photons: each sample of all pixels has photons of its own (docs/light.md).
class CausticPasses {
public:
    /// Of the job's world, which has a photon use.
    explicit CausticPasses(Job&);
    /// Whether Hider "path" "caustics" is set.
    static bool asked(const scene::Options&);
    /// Call before tracing: finds caustics by photons, for guiding or for density estimation. Returns false if stopped.
    bool prepare() { return begun_ || begin(); }
    /// Call before samples first to first + count - 1 of any pixel are traced. Returns false if stopped.
    bool ready(uint32_t first, uint32_t count);

private:
    bool begin();
    float widthOf(const scene::Options&);
    Job& job_;
    std::unique_ptr<PhotonPasses> passes_; ///< null: no caustics, or not requested
    bool begun_ = false;
    uint32_t count_ = 0; ///< photons of a pass
    float radius_ = 0;   ///< of the first pass
    float window_ = 1;   ///< time window of its photons, as a fraction of the open shutter
    bool moves_ = false;
};

} // namespace alpenglow::render

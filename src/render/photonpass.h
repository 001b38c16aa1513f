// Photon passes of a frame: maps that are written or made for its shaders, and the caustics of the hider path. Inside render/.
#pragma once
#include "integrator/photons.h"
#include "render/rendering.h"
#include <functional>

namespace alpenglow::render {

/// Emits photons on the threads of a job, with progress.
class PhotonPasses {
public:
    PhotonPasses(Job&, std::shared_ptr<const transport::World>, const transport::PhotonUse&);
    /// The same, with messages for somebody else.
    PhotonPasses(Job&, std::shared_ptr<const transport::World>, const transport::PhotonUse&, Diagnostics&);
    transport::PhotonEmission& emission() { return emission_; }
    /// All photons that come to rest of `count` of a pass. False: stopped, or more than limits::kPhotons came to rest, which was
    /// reported; then *emitted is how many were emitted of which these are.
    bool emit(uint32_t pass, uint64_t count, std::vector<transport::StoredPhoton>& stored, const std::string& what,
              uint64_t* emitted);
    /// Of passes first to first + passes - 1 each by itself: take(pass, stored) has what came to rest of `count` photons, pass by
    /// pass. Once more than `most` did, no more are emitted of that pass, which is reported once; these then carry the light of
    /// all. False: stopped.
    bool emit(uint32_t first, uint32_t passes, uint32_t count, size_t most,
              const std::function<void(uint32_t pass, std::vector<transport::StoredPhoton>)>& take);
    /// How far lights, and the surfaces that photons have met so far, move while the shutter is open.
    float travel() const;

private:
    bool emitBlocks(uint32_t first, uint32_t count, size_t begin, size_t end,
                    std::vector<std::vector<transport::StoredPhoton>>& of);
    transport::PhotonEmission::Thread& thread(int worker);
    Job& job_;
    Diagnostics& diagnostics_;
    transport::PhotonEmission emission_;
    std::vector<std::unique_ptr<transport::PhotonEmission::Thread>> threads_; ///< by worker
};

/// Photons that Hider or Option "photon" "emit" asks for, at most limits::kPhotonsEmitted; more are reported.
uint64_t photonsToEmit(const scene::Options&, Diagnostics&);

/// Caustics of the hider path: for each sample of all pixels photons of their own (design: docs/light.md).
class CausticPasses {
public:
    explicit CausticPasses(Job&);
    /// Whether Hider "path" "caustics" asks for them.
    static bool asked(const scene::Options&);
    /// Before anything is traced: finds caustics by photons, which paths then aim at, or which stand for them. False: stopped.
    bool prepare() { return begun_ || begin(); }
    /// Before samples first to first + count - 1 of any pixel are traced. False: stopped.
    bool ready(uint32_t first, uint32_t count);

private:
    bool begin();
    float widthOf(const scene::Options&);
    Job& job_;
    std::unique_ptr<PhotonPasses> passes_; ///< null: there are no caustics, or nobody asks for them
    bool begun_ = false;
    uint32_t count_ = 0; ///< photons of a pass
    float radius_ = 0;   ///< of the first pass
    float window_ = 1;   ///< and for how long its photons are there, of the time that the shutter is open
    bool moves_ = false;
};

} // namespace alpenglow::render

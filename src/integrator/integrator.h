// All that other folders use of light transport: the light along camera rays (Integrator), emission of photons (PhotonEmission),
// and what is learned of lights before the first sample. All of it is constructed from a frame prepared for rendering (World).
// Under "hidden" and "raytrace" shaders keep their classic RenderMan semantics; under "path" all light reaches their lobes
// (docs/design/light-transport.md).
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "geometry/plane.h"
#include "integrator/samples.h"
#include "scene/fwd.h"
#include "scene/primitive.h"
#include "world/causticseeds.h"
#include "world/storedphoton.h"
#include "world/world.h"
#include <memory>
#include <span>
#include <vector>

namespace alpenglow::integrator {

/// World::build() with an Evaluator that runs kernels as the integrator does.
std::shared_ptr<const World> buildWorld(const std::shared_ptr<const scene::Frame>&, const Settings&, Diagnostics&);

/// Light along camera rays. One for each thread; it is expensive to construct.
class Integrator {
public:
    /// Of World::build(); diagnostics outlive this.
    explicit Integrator(std::shared_ptr<const World>, Diagnostics&);
    ~Integrator();
    /// Traces all rays to the end. Results do not depend on which rays share a call. Returns false if `stop` was set; the results
    /// are then undefined. Use one Integrator per thread.
    bool trace(std::span<const CameraRay>, std::span<SampleResult>, const StopFlag* stop);
    /// Whether camera rays within all of these half-spaces are known to hit nothing and to be black, so that they need not be
    /// traced. Conservative: false means unknown. True mainly under hidden.
    bool seesNothing(std::span<const geometry::Plane>) const;
    /// Whether a ray of the last trace() reached the bound of a deferred procedural; its results are then undefined (deferred.h).
    bool unfinished() const;
    /// Of all calls so far.
    const Counters& counters() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Purpose of an emission.
struct PhotonUse {
    bool all = true;       ///< if no light sets "emitphotons", all lights emit
    bool sky = true;       ///< environments emit, too; learns: where they are bright, if few directions are
    bool caustics = false; ///< stores caustic photons only
    float width = 0;       ///< lobes with a smaller spread, in radians, count as mirrors
    bool learns = false;   ///< for the caustic guide: only lights that rays can find emit, shaders do not print or bake
    bool unmet = false;    ///< with `learns`: only lights that no ray meets emit: point, spot and distant lights that do not move
};

/// Emits photons in one world, which must have been built for the hider path.
class PhotonEmission {
public:
    /// For one PhotonUse. Diagnostics outlive this.
    PhotonEmission(std::shared_ptr<const World>, const PhotonUse&, Diagnostics&);
    ~PhotonEmission();
    bool lights() const;  ///< whether any light emits
    bool moves() const;   ///< whether anything moves that photons may hit or leave
    double power() const; ///< total luminance, approximate
    /// Adapts emission to the stored photons of a pass of `emitted` photons: later passes send more where these went. Call while
    /// no thread emits.
    void learn(std::span<const StoredPhoton>, uint32_t pass, uint32_t emitted);
    /// With PhotonUse::unmet: appends the starts of stored photons of a pass, from which they can be sent again.
    void addSeeds(std::span<const StoredPhoton>, uint32_t pass, std::vector<CausticSeed>&, Diagnostics&) const;
    /// Marks the lights that emit here as those whose light the photon passes carry.
    void markPhotonLights() const;

    /// The emitter of one thread.
    class Thread {
    public:
        /// Diagnostics receive what this thread reports.
        Thread(const PhotonEmission&, Diagnostics&);
        ~Thread();
        /// Emits photons `first` to first + count - 1 of a pass of `emitted` photons and appends the stored ones to `out`, in the
        /// order of their numbers. Returns false if stopped; `out` is then undefined.
        bool emit(uint32_t pass, uint32_t first, uint32_t count, double emitted, std::vector<StoredPhoton>& out,
                  const StopFlag* stop);
        /// Of all calls so far.
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

/// Mirrors that the probes of a search meet on average, at some of the places where photons came to rest: its cost.
double costOfSearches(const std::shared_ptr<const World>&, const CausticSeeds&, Diagnostics&);

/// Size of the light guides of a world.
struct LightGuideFigures {
    uint64_t samples = 0;         ///< light samples that were seen unoccluded
    uint64_t lights = 0;          ///< that have a guide
    uint64_t cells = 0, used = 0; ///< used: where light samples follow the guide
};
/// Removes the light guides of a world.
void forgetLights(const World&);
/// Whether paths may be traced before those of the picture: under path, if no procedural waits and no shader bakes.
bool mayTraceBefore(const World&);
/// Whether a light of this world may have a guide: a flat emitter, or a sky that is sampled. Lights that vertices choose at
/// random among many have none.
bool mayGuideLights(const World&);
/// Traces these paths and builds guides where a guide makes light samples less noisy; other paths use them from now on. Call
/// while no thread traces. Returns false if `stop` was set; the guides are then as before.
bool learnLights(const std::shared_ptr<const World>&, std::span<const CameraRay>, Diagnostics&, const StopFlag* stop,
                 LightGuideFigures&);

} // namespace alpenglow::integrator

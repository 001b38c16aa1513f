// Photon maps: those that Hider "photon" writes, and those that shaders of a frame read.
#include "render/framework.h"
#include "render/levels.h"
#include "render/photonpass.h"
#include "world/photonmaps.h"

namespace alpenglow::render {

void Renderer::renderPhotons(FrameWork& f, int threads) {
    f.settings = engineSettings(f);
    const auto refuse = [&](const std::string& why, const std::string& hint) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Error, Rie::MissingData, f.o.hiderPlace, why, hint);
    };
    f.world = engine_.build(drawnLevels(f.frame, f.camera), f.settings, diagnostics_);
    if (abandons(f)) return;
    if (!f.world || !f.world->photons()) {
        outcome_.interrupted |= settings_.stop && *settings_.stop;
        ++outcome_.refused;
        return;
    }
    const std::vector<std::string> maps = world::photonMapsOf(*f.world, true);
    if (maps.empty())
        return refuse("Hider \"photon\": no surface and no shader of the frame names a photon map",
                      "Attribute \"photon\" \"string globalmap\" \"room.photons\"");
    const double cpu = processCpuSeconds();
    Job job(settings_, f.camera, f.plan, engine_, f.world, threads, progress_, diagnostics_);
    if (f.o.abortsOnError) job.errorsAllowed = f.errorsBefore;
    PhotonPasses passes(job, f.world, {});
    if (!passes.emission().lights())
        return refuse("Hider \"photon\": no light of the frame emits photons",
                      "ambient lights and lights without a position emit none");
    std::vector<world::StoredPhoton> stored;
    uint64_t emitted = 0;
    const bool whole = passes.emit(0, photonsToEmit(f.o, diagnostics_), stored, maps.front(), &emitted);
    noteInterrupted(job);
    stats_.renderSec += job.elapsed();
    stats_.cpuSec += processCpuSeconds() - cpu;
    if (abandons(f)) return;
    if (!whole) {
        ++outcome_.refused;
        diagnostics_.report(Severity::Warning, Rie::NoError, {},
                            "interrupted while photons were emitted; no photon map is written");
        return;
    }
    ++outcome_.rendered;
    awaitTurn();
    for (const auto& [name, photons] : world::photonsByMap(*f.world, maps, stored)) {
        if (photons.empty())
            diagnostics_.report(Severity::Warning, Rie::NoError, {},
                                "photon map \"" + name + "\" is empty: no photon was stored on its surfaces");
        const bool saved = world::savePhotonMap(*f.world, name, photons, emitted, settings_.allowWrite, diagnostics_);
        outcome_.outputFailed |= !saved;
        if (saved)
            diagnostics_.report(Severity::Info, Rie::NoError, {},
                                "photon map \"" + name + "\": " + std::to_string(photons.size()) + " photons, " +
                                    std::to_string(emitted) + " emitted");
    }
}

void Renderer::makePhotonMaps(FrameWork& f, Job& job) {
    if (!f.world->photons()) return;
    const std::vector<std::string> maps = world::photonMapsOf(*f.world, false);
    if (maps.empty()) return;
    // Under path shaders request lobes; under the other hiders they evaluate lights themselves.
    Diagnostics silent; // its messages were reported when the frame was built
    std::shared_ptr<const world::World> world = f.world;
    if (!f.path) {
        world::Settings settings = f.settings;
        settings.hider = Hider::Path;
        world = engine_.build(drawnLevels(f.frame, f.camera), settings, silent);
        if (!world || !world->photons()) return;
    }
    PhotonPasses passes(job, world, {.all = false});
    if (!passes.emission().lights()) return; // lookups report a missing map
    std::vector<world::StoredPhoton> stored;
    uint64_t emitted = 0;
    if (!passes.emit(0, photonsToEmit(f.path ? scene::Options(f.o) : f.o, diagnostics_), stored, "photons", &emitted)) return;
    for (auto& [name, photons] : world::photonsByMap(*world, maps, stored))
        world::setPhotonMap(*f.world, name, std::move(photons));
}

} // namespace alpenglow::render

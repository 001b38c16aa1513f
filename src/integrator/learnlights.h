// Learns guides for light samples (world/lightguide.h) from the light samples of some paths that are not those of the picture.
#pragma once
#include "base/diagnostics.h"
#include "base/stopflag.h"
#include "integrator/samples.h"
#include "world/world.h"
#include <memory>
#include <span>

namespace alpenglow::integrator {

/// Size of the light guides of a world.
struct LightGuideFigures {
    uint64_t samples = 0;         ///< light samples that were seen unoccluded
    uint64_t lights = 0;          ///< that have a guide
    uint64_t cells = 0, used = 0; ///< used: where light samples follow the guide
};
/// Removes the guides of a world.
void forgetLights(const World&);
/// Whether a light of this world may have a guide: a flat emitter, or a sky that is sampled. Lights that vertices choose at
/// random among many have none.
bool mayGuideLights(const World&);
/// Traces these paths and builds guides where a guide makes light samples less noisy; other paths use them from now on. Call
/// while no thread traces. Returns false if `stop` was set; the guides are then as before.
bool learnLights(const std::shared_ptr<const World>&, std::span<const CameraRay>, Diagnostics&, const StopFlag* stop,
                 LightGuideFigures&);

} // namespace alpenglow::integrator

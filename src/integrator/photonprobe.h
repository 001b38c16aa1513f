// Probes: photons that are sent to learn where mirrors and glass lead them, and stored nowhere.
#pragma once
#include "integrator/names.h"
#include "services/random.h"
#include <cstdint>

namespace alpenglow::integrator {

/// A photon that is sent to learn where mirrors and glass lead it (specularsearch.h). Camera space.
struct PhotonProbe {
    int light = -1;   ///< in WorldImpl::lights(): one that no ray meets
    Vec3 origin, dir; ///< dir: unit
    float time = 0;   ///< as a fraction of the open shutter
    Vec2 cone;        ///< EmissionDraw::cone
    /// Of the photon that it repeats.
    SampleNumbers numbers{Sampler(0, 0, 0), 0};
    int bounces = 0;    ///< it ends as it leaves this many mirrors
    bool power = false; ///< asks for ProbeEnd::light
};

/// How a probe leaves its last mirror.
struct ProbeEnd {
    bool arrives = false; ///< it has left that many mirrors
    Vec3 origin, dir;     ///< dir: unit
    Color light{0};       ///< fraction that mirrors and air leave; with PhotonProbe::power times the light of its shader, as
                          ///< intensity over pi for a light with a place, as irradiance over pi for a distant one
    float keptDiffuse = 1, keptSpecular = 1; ///< with PhotonProbe::power: LightValue::kept()
    float chance = 1;                        ///< probability of all random choices on the way; `light` does not contain it
    uint64_t way = 0;                        ///< hash of the surfaces and lobes on the way
};

} // namespace alpenglow::integrator

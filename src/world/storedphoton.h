// The result of a photon emission.
#pragma once
#include "photonmap/photon.h"
#include "world/names.h"

namespace alpenglow::world {

/// A stored photon.
struct StoredPhoton {
    photonmap::Photon photon;
    uint32_t number = 0;  ///< number in the emission
    int32_t binding = 0;  ///< of the surface that stores it
    Vec3 way;             ///< from the point toward the surface that reflected it here, if any
    float time = 0;       ///< when it was emitted, as a fraction of the open shutter
    bool caustic = false; ///< came by delta lobes only (mirrors, glass), at least one
};

} // namespace alpenglow::world

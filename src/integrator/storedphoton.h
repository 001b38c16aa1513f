// What an emission of photons gives.
#pragma once
#include "photons/photon.h"

namespace alpenglow::transport {

/// A photon at rest.
struct StoredPhoton {
    photons::Photon photon;
    uint32_t number = 0;  ///< of the emission
    int32_t binding = 0;  ///< of the surface
    Vec3 way;             ///< from the point to where a surface sent it here, if one did
    float time = 0;       ///< at which it was sent, as part of the time that the shutter is open
    bool caustic = false; ///< came by way of single directions alone (mirrors, glass), at least one
};

} // namespace alpenglow::transport

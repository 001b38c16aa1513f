// Photon attributes and calls.
#pragma once
#include "world/mutableworld.h"

namespace alpenglow::world {

/// Reads Attribute "photon" of a surface; reports unknown names. MutableWorld::bindPhotons() sets `meets` and `intersectsBoth`.
PhotonBinding photonsOf(const scene::Attributes&, Diagnostics&);

/// A key that differs for surfaces with different photonsOf() or visibility; "" without photon attributes.
std::string photonKey(const scene::Attributes&);

/// Arguments of a photonmap() or caustic() call. Registers the maps that it needs with the world.
std::shared_ptr<const PhotonSite> photonSite(const SiteInfo&, const rsl::CompiledKernel&, const WorldImpl&);

/// Attribute "light" "emitphotons": whether a light emits photons; nothing: not set.
std::optional<bool> emitsPhotons(const BoundLight&);

} // namespace alpenglow::world

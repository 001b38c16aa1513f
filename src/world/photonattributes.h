// What attributes and calls say of photons.
#pragma once
#include "world/impl.h"

namespace alpenglow::transport {

/// Attribute "photon" of a surface; names that are not known are reported. `meets` and `meetsBoth`: WorldImpl::bindPhotons().
PhotonBinding photonsOf(const scene::Attributes&, Diagnostics&);

/// Tells surfaces apart whose photonsOf() or visibility differ; "" without attributes of photons.
std::string photonKey(const scene::Attributes&);

/// A photonmap() or caustic(). The world is told which maps it asks for.
std::shared_ptr<const PhotonSite> photonSite(const SiteInfo&, const rsl::CompiledKernel&, WorldImpl&);

/// Whether a light emits photons: Attribute "light" "emitphotons"; nothing: it is not said.
std::optional<bool> emitsPhotons(const BoundLight&);

} // namespace alpenglow::transport

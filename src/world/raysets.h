// What trace(), transmission() and their kin say about the rays they send.
#pragma once
#include "world/world.h"

namespace alpenglow::transport {

/// "specular" (and what is not known), "diffuse", "transmission".
RayType rayTypeOf(const std::string& word);

/// Reads the optional parameters of a call; words that are not known are reported.
std::shared_ptr<const RaySite> raySite(const SiteInfo&, WorldImpl&, const SourcePlace&);

} // namespace alpenglow::transport

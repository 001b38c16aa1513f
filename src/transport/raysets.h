// What trace(), transmission() and their kin say about the rays they send.
#pragma once
#include "transport/world.h"

namespace alpenglow::transport {

/// "specular" (and what is not known), "diffuse", "transmission".
RayType rayTypeOf(const std::string& word);

/// Reads the optional parameters of a call; words that are not known are reported.
std::shared_ptr<const RaySite> raySite(const SiteInfo&, WorldImpl&, const SourcePlace&);

/// For one call. f: a row of its arguments; from: the shape whose shader calls, or null, whose Attribute "grouping" "tracesubset" holds where
/// no subset is given. Also tells the type and the label of the rays.
shading::RaySet raySetOf(const WorldImpl&, const SiteInfo&, const std::function<float(int)>& f, const geometry::Shape* from, RayType& type, int32_t& label);

} // namespace alpenglow::transport

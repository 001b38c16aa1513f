// What trace(), transmission() and their kin say about the rays they send.
#pragma once
#include "world/impl.h"
#include <optional>

namespace alpenglow::transport {

/// The first text of an attribute; "" where it is not set.
std::string attributeText(const scene::Attributes&, const char* key);
/// "front", "back" ("reversed"), "both"; "primitive", "shader", "default". Nothing for other words.
std::optional<accel::Sides> sidesOf(const std::string& word);
std::optional<shading::HitMode> modeOf(const std::string& word);
/// "specular" (and what is not known), "diffuse", "transmission".
RayType rayTypeOf(const std::string& word);

/// Reads the optional parameters of a call; words that are not known are reported.
std::shared_ptr<const RaySite> raySite(const SiteInfo&, WorldImpl&, const SourcePlace&);

} // namespace alpenglow::transport

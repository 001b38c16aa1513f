// Optional ray parameters of trace(), transmission() and similar calls.
#pragma once
#include "world/impl.h"
#include <optional>

namespace alpenglow::world {

/// The first string of an attribute; "" if not set.
std::string attributeText(const scene::Attributes&, const char* key);
/// "front", "back" ("reversed"), "both"; "primitive", "shader", "default". Returns nothing for other words.
std::optional<accel::Sides> sidesOf(const std::string& word);
std::optional<shading::HitMode> modeOf(const std::string& word);
/// "specular" (also for unknown words), "diffuse", "transmission".
RayType rayTypeOf(const std::string& word);

/// Reads the optional parameters of a call; reports unknown words.
std::shared_ptr<const RaySite> raySite(const SiteInfo&, const WorldImpl&, const SourcePlace&);

} // namespace alpenglow::world

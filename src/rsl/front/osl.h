// Shaders of the Open Shading Language as RSL: text to text, for the core that patterns are written in (docs/ris.md has what that
// is). OSL Language Specification 1.12; the two languages share their forms, so what is alike passes through as it stands.
#pragma once
#include "base/diagnostics.h"
#include <optional>
#include <string>

namespace alpenglow::rsl::front {

/// The RSL of an OSL text, line for line: its shaders are surface shaders of the same parameters and outputs, which patterns are
/// (scene/network.h). path: for messages. Nothing after an error (closures, structures, what RSL cannot say), which is reported
/// with its place.
std::optional<std::string> rslFromOsl(const std::string& osl, const std::string& path, Diagnostics&);

} // namespace alpenglow::rsl::front

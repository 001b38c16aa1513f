// Checks parameter values from a scene against the declaration in the shader.
#pragma once
#include "base/diagnostics.h"
#include "rsl/compiler.h"
#include "scene/param.h"
#include "world/names.h"
#include <optional>

namespace alpenglow::world {

/// The value with the declared type, not transformed. Arrays of open length get at most limits::kShaderArray elements. One number
/// becomes a grey color. Other types with the same number of components are accepted with a warning; point, vector and normal
/// count as equal, as do types that the scene guessed. Returns nothing if the type or length does not fit: the error is reported
/// once for each shader, parameter and value, and the default applies.
std::optional<rsl::ParameterValue> fitParameter(const scene::Param& given, const rsl::ParameterInfo& declared,
                                                const std::string& shader, const SourcePlace& call, Diagnostics&);

} // namespace alpenglow::world

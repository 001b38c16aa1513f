// Whether what a scene gives a shader's parameter is what the shader declares.
#pragma once
#include "base/diagnostics.h"
#include "rsl/compiler.h"
#include "scene/param.h"
#include <optional>

namespace alpenglow::transport {

/// The value as the shader declares it, not yet transformed; of an array of open length as many elements as fit into both it and
/// limits::kShaderArray. One number is a grey where a color is wanted. Nothing: it is of another type or length, an error was
/// reported once for the shader, the parameter and what was given, and the default holds. Other types of as many numbers are
/// taken, with a warning; points, vectors and normals are one type here, and the scene's guesses none.
std::optional<rsl::ParameterValue> fitParameter(const scene::Param& given, const rsl::ParameterInfo& declared,
                                                const std::string& shader, const SourcePlace& call, Diagnostics&);

} // namespace alpenglow::transport

// Converts changes made in a view to requests for the scene.
#pragma once
#include "view/materials.h"

namespace alpenglow::view {

/// A shader call with replaced parameters: Surface "plastic" "float Kd" 0.5.
std::string ribOfShader(const ShaderUse&, const scene::ParamList& changes);

/// The same of a light that was dimmed. `byDefault`: of the parameter "intensity", where the shader has one.
std::string ribOfDimmedLight(const ShaderUse&, const scene::ParamList& changes, double factor, std::optional<double> byDefault);

/// The transformations before WorldBegin that replace the scene's.
std::string ribOfCamera(const scene::Options&);

} // namespace alpenglow::view

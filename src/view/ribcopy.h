// What was tuned in a view as requests, to be taken into the scene.
#pragma once
#include "view/materials.h"

namespace alpenglow::view {

/// The call of a shader, with parameters that take the place of its own: Surface "plastic" "float Kd" 0.5.
std::string ribOfShader(const ShaderUse&, const scene::ParamList& changes);

/// The same of a light that was dimmed. `byDefault`: of the parameter "intensity", where the shader has one.
std::string ribOfDimmedLight(const ShaderUse&, const scene::ParamList& changes, double factor, std::optional<double> byDefault);

/// What stands before WorldBegin in the place of the scene's own transformations.
std::string ribOfCamera(const scene::Options&);

} // namespace alpenglow::view

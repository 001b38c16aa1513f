// Lights as shader objects: surfaces call their public methods and read their public members, as for co-shaders.
#pragma once
#include "base/matrix.h"
#include "rsl/compiler.h"
#include "world/names.h"
#include <set>
#include <string>

namespace alpenglow::world {

/// Names of methods and members that a shader uses on handles from getlights() or getlight(), as far as its text shows. Without
/// light(L, Cl) and light(L, Cl, Ol), which the renderer implements.
std::set<std::string> calledOfLights(const rsl::Program&);

/// Whether the light is a class with a public method or member of one of these names; a method light() counts only with more
/// parameters.
bool answers(const rsl::CompiledShader& light, const std::set<std::string>& names);

/// Whether a light reads P within illuminate() or solar(): Ps is the lit point there, and P the light's own position.
bool readsOwnPoint(const rsl::Shader& light);

/// A name for the space with this matrix to "current".
std::string spaceAt(const Matrix& toCurrent);

/// Recovers the matrix from a name made by spaceAt(); returns false for any other name.
bool placeOf(const std::string& space, Matrix& toCurrent);

} // namespace alpenglow::world

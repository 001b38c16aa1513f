// Lights that are shader objects: surfaces call their public methods and read their public members, as those of co-shaders.
#pragma once
#include "base/matrix.h"
#include "rsl/compiler.h"
#include <set>
#include <string>

namespace alpenglow::transport {

/// Names of methods and members that a shader asks of handles which getlights() or getlight() gave, as far as its text shows.
/// light(L, Cl) and light(L, Cl, Ol) are not among them: the renderer answers those.
std::set<std::string> calledOfLights(const rsl::Program&);

/// Whether the light is a class with a public method or member of one of these names; a method light() counts with more
/// parameters only.
bool answers(const rsl::CompiledShader& light, const std::set<std::string>& names);

/// Whether a light reads P within illuminate() or solar(), where Ps is the point being lit: P is its own place.
bool readsOwnPoint(const rsl::Shader& light);

/// A name for the space that this matrix takes to "current".
std::string spaceAt(const Matrix& toCurrent);

/// The matrix of a name that spaceAt() gave; false for any other name.
bool placeOf(const std::string& space, Matrix& toCurrent);

} // namespace alpenglow::transport

// Shader outputs that displays request.
#pragma once
#include "world/bound.h"

namespace alpenglow::world {

/// Whether a shader or its co-shaders have an output of that name ("list[1]" is an element of "list").
bool gives(const ShaderInstance&, const rsl::OutputName&);
/// The same for outputchannel() only.
bool givesChannel(const ShaderInstance&, const rsl::OutputName&);
/// Whether a shader computes the name at run time, so that it may write this output.
bool givesPerhaps(const ShaderInstance&, const rsl::OutputName&);
/// Indices of a kernel's outputs that form the AOV of a name; all elements for an array. Empty: none.
std::vector<int> outputsNamed(const shading::Batch&, const rsl::OutputName&);
/// Appends an output that displays request, and before it the one that says where it is written.
void addOutput(const ShaderInstance&, const rsl::OutputName&, std::vector<std::string>& outputs);
/// Returns false if the shader could have written this output at the point, and did not.
bool givenAt(const shading::Batch&, const rsl::OutputName&, int point);

} // namespace alpenglow::world

// Outputs of shaders as displays ask for them.
#pragma once
#include "world/bound.h"

namespace alpenglow::transport {

/// Whether a shader or its co-shaders give an output of that name ("list[1]" is an element of "list").
bool gives(const ShaderInstance&, const rsl::OutputName&);
/// The same of outputchannel() alone.
bool givesChannel(const ShaderInstance&, const rsl::OutputName&);
/// Whether a shader gives an output only where it makes that name when it runs.
bool givesPerhaps(const ShaderInstance&, const rsl::OutputName&);
/// The outputs of a kernel that make up the AOV of a name: of an array all its elements. Empty: it has none.
std::vector<int> outputsNamed(const shading::Batch&, const rsl::OutputName&);
/// Adds to the outputs of a kernel one that displays ask for, and before it the one that tells where it is given.
void addOutput(const ShaderInstance&, const rsl::OutputName&, std::vector<std::string>& outputs);
/// False where the shader might have made this output at the point, and did not.
bool givenAt(const shading::Batch&, const rsl::OutputName&, int point);

} // namespace alpenglow::transport

// Whether a shader moves the points that it is run at, with the values that its parameters have in a scene.
#pragma once
#include "rsl/kernel.h"
#include <map>

namespace alpenglow::rsl {

struct Program;
struct Shader;

/// False: it leaves P as it is wherever it runs, when its parameters are `numbers`, but for the varying and the computed ones of
/// the options: what it adds to P is 0, or a condition on them keeps it from being added.
bool movesPoints(const Program&, const Shader&, KernelOptions, const std::map<std::string, std::vector<float>>& numbers);

} // namespace alpenglow::rsl

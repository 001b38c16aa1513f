// Divisions by zero that come from the values of a shader's parameters, where a literal zero would be warned of as well.
#pragma once
#include "base/diagnostics.h"
#include "rsl/kernel.h"
#include <map>

namespace alpenglow::rsl {

struct Program;
struct Shader;

/// Numeric parameters of a shader that are written in divisors and have a component of 0. In order.
std::vector<std::string> zeroDivisors(const Program&, const Shader&, const std::map<std::string, std::vector<float>>& numbers);

/// Makes constants of parameters of one or three numbers that are the same for the whole instance: neither varying nor computed.
void fixParameters(KernelOptions&, const std::map<std::string, std::vector<float>>& numbers);

/// Where the shader divides by zero when its parameters are `numbers`, but for the varying and the computed ones of the options:
/// what no condition on them keeps from running.
std::vector<SourcePlace> divisionsByZero(const Program&, const Shader&, KernelOptions,
                                         const std::map<std::string, std::vector<float>>& numbers);

} // namespace alpenglow::rsl

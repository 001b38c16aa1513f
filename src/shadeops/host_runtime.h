// Facts about the program's own copy of the runtime (4 lanes), beyond evaluateRuntime.
#pragma once
#include <string_view>
#include <vector>

namespace alpenglow::shadeops {

/// Floats that a symbol takes and gives at order 0; {0, 0} when it is unknown.
struct RuntimeShape {
    int in = 0, out = 0; ///< floats
};
RuntimeShape runtimeShape(std::string_view symbol);

/// Every symbol of the runtime, those that no signature names too.
std::vector<std::string_view> runtimeSymbols();

} // namespace alpenglow::shadeops

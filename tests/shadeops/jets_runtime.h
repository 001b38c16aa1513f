// The runtime on jets at 4 lanes: the program itself holds the functions of order 0 alone.
#pragma once
#include <string_view>

namespace alpenglow::shadeops {

/// evaluateRuntime on jets: order 0, 1 or 2, each component as its 1, 3 or 6 parts {v, du, dv, duu, duv, dvv}. Order 0 is the
/// program's own copy. False when the symbol is unknown or the counts do not fit.
bool evaluateRuntimeJet(std::string_view symbol, int order, const float* in, int inCount, float* out, int outCount);

} // namespace alpenglow::shadeops

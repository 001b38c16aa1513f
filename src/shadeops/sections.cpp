// The sections that hold code, compiled into the program at 4 lanes: descriptors, and evaluateRuntime.
#define ALPENGLOW_DESCRIBE
#include "shadeops/describe.h"
//
#include "shadeops/colours.h"
#include "shadeops/geometry.h"
#include "shadeops/lighting.h"
#include "shadeops/mathematics.h"
#include "shadeops/matrices.h"
#include "shadeops/noise.h"
#include "shadeops/splines.h"

namespace alpenglow::rsl {
bool evaluateRuntime(std::string_view symbol, const float* in, int inCount, float* out, int outCount) { return false; }
} // namespace alpenglow::rsl

// The compiler works on the types of the shading language and on the descriptors of its functions: their names stand here without
// a prefix.
#pragma once

namespace alpenglow::shadeops {}

namespace alpenglow::rsl {

using namespace shadeops;

} // namespace alpenglow::rsl

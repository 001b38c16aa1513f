// Blocks of points hold BSDF lobes: their names stand here without a prefix.
#pragma once

namespace alpenglow::bsdf {}

namespace alpenglow::lanes {

using namespace bsdf;

} // namespace alpenglow::lanes

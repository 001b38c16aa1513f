// The integrator works on the bound scene, on blocks of points and on BSDF lobes: their names stand here without a prefix.
#pragma once

namespace alpenglow::bsdf {}
namespace alpenglow::lanes {}
namespace alpenglow::services {}
namespace alpenglow::world {}

namespace alpenglow::integrator {

using namespace bsdf;
using namespace lanes;
using namespace services;
using namespace world;

} // namespace alpenglow::integrator

// Services answer from the bound scene: its names stand here without a prefix.
#pragma once

namespace alpenglow::bsdf {}
namespace alpenglow::lanes {}
namespace alpenglow::world {}

namespace alpenglow::services {

using namespace bsdf;
using namespace lanes;
using namespace world;

} // namespace alpenglow::services

// The bound scene refers to BSDFs and to blocks of points: their names stand here without a prefix.
#pragma once

namespace alpenglow::bsdf {}
namespace alpenglow::lanes {}

namespace alpenglow::world {

using namespace bsdf;
using namespace lanes;

} // namespace alpenglow::world

// How large the pieces are that a primitive is shaded in.
#pragma once
#include "scene/primitive.h"

namespace alpenglow::scene {

/// Area of a micropolygon in pixels: ShadingRate, times Attribute "shade" "relativeshadingrate" where that is positive (PRMan).
inline float shadedArea(const Attributes& a) {
    const Param* p = a.value("shade:relativeshadingrate");
    return p && !p->numbers.empty() && p->numbers[0] > 0 ? a.shadingRate * p->numbers[0] : a.shadingRate;
}

} // namespace alpenglow::scene

// Half-spaces, for the visible region of a part of a picture.
#pragma once
#include "base/vec.h"

namespace alpenglow::geometry {

/// The half-space dot(n, p) + d >= 0. Camera space.
struct Plane {
    Vec3 n;
    float d = 0;
};

} // namespace alpenglow::geometry

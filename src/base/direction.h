// Directions that shaders give, of any length.
#pragma once
#include "base/vec.h"
#include <algorithm>

namespace alpenglow {

/// Unit vector along a, however long or short it is; the fallback where a has no direction (zero, or a number that is not
/// finite). normalizeOr() knows no lengths whose square no float holds.
inline Vec3 directionOr(const Vec3& a, const Vec3& fallback) {
    const float most = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
    if (most > 1e-15f && most < 1e15f) return normalizeOr(a, fallback);
    const Vec3d d = normalizeOr(Vec3d(a), Vec3d(0));
    return dot(d, d) > 0 ? Vec3(d) : fallback;
}

} // namespace alpenglow

// Directions of any length, as shaders pass them.
#pragma once
#include "base/vec.h"
#include <algorithm>

namespace alpenglow {

/// Unit vector along a, of any length; the fallback if a has no direction (zero or not finite). normalizeOr() fails for lengths
/// whose square overflows or underflows.
inline Vec3 directionOr(const Vec3& a, const Vec3& fallback) {
    const float most = std::max({std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)});
    if (most > 1e-15f && most < 1e15f) return normalizeOr(a, fallback);
    const Vec3d d = normalizeOr(Vec3d(a), Vec3d(0));
    return dot(d, d) > 0 ? Vec3(d) : fallback;
}

} // namespace alpenglow

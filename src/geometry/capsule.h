// Lines with a width, around pieces of curves: cheaper to miss than the pieces, and closer to them than boxes.
#pragma once
#include "base/vec.h"
#include <cstdint>

namespace alpenglow::geometry {

/// All points within `radius` of the line from a to a + along.
struct Capsule {
    Vec3 a;
    float radius = 0;
    Vec3 along;
    /// Added to the square of a distance that is compared with the radius: how far that may be off where `along` is long and
    /// thin.
    float excess = 0;
    static Capsule between(const Vec3d& a, const Vec3d& b, double radius) {
        Capsule c;
        c.a = Vec3(a);
        c.along = Vec3(b - a);
        const double e = length(b - a), size = std::fabs(a.x) + std::fabs(a.y) + std::fabs(a.z) + e;
        c.radius = float((radius + 1e-6 * size) * (1 + 1e-6));
        c.excess = float(2e-6 * (e + radius) * (e + radius));
        return c;
    }
};

/// Shapes that rays meet one primitive at a time (Shape::exactPrims()) and that know capsules around them.
class InCapsules {
public:
    virtual ~InCapsules() = default;
    /// Encloses all that a ray can hit of a primitive, camera space. False: none does.
    virtual bool capsule(uint32_t prim, Capsule&) const = 0;
};

} // namespace alpenglow::geometry

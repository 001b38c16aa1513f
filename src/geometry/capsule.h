// Lines with a width, around pieces of curves: cheaper to miss than the pieces, and closer to them than boxes.
#pragma once
#include "base/vec.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

namespace alpenglow::geometry {

/// All points within `radius` of the line from a to a + along.
struct Capsule {
    Vec3 a;
    float radius = 0;
    Vec3 along;
    /// Added to the square of a distance that is compared with the radius: how far that may be off where `along` is long and
    /// thin.
    float excess = 0;
    /// Whether a ray may pass through. Never false for one that does. slack: how far its origin may be off.
    bool mayPass(const Vec3& org, const Vec3& dir, float slack = 0) const {
        const float dd = dot(dir, dir), inverse = 1 / dd;
        const Vec3 w = a - org, across = w - dir * (dot(w, dir) * inverse), sideways = along - dir * (dot(along, dir) * inverse);
        // NaN gives an end.
        const float s = std::min(1.f, std::max(0.f, -dot(across, sideways) / dot(sideways, sideways)));
        const Vec3 nearest = across + sideways * s;
        const auto norm = [](const Vec3& v) { return std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z); };
        const float reach = radius + 0x1p-19f * (norm(w) + norm(along)) + 2 * slack;
        return !(dd > 1e-30f) || !(dot(nearest, nearest) > reach * reach + excess);
    }
    /// Around a line from a to b and everything within `radius` of it, with room for rounding to float.
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

/// Shapes with primitives intersected one at a time (Shape::exactPrims()) and known capsules around them.
class InCapsules {
public:
    virtual ~InCapsules() = default;
    /// A capsule around all hits of a primitive, camera space. Returns false if there is none.
    virtual bool capsule(uint32_t prim, Capsule&) const = 0;
    /// The same for consecutive primitives; infinite radius if there is none.
    virtual void capsules(uint32_t first, std::span<Capsule> out) const {
        for (Capsule& c : out)
            if (!capsule(first++, c)) c.radius = INFINITY;
    }
    /// Prefetches the data for exactHits() of a primitive.
    virtual void fetch(uint32_t prim) const = 0;
};

} // namespace alpenglow::geometry

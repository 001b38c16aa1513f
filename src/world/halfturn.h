// Light samples on surfaces of revolution (cylinders, cones, tori, ...): a point that faces away from the lit point is replaced
// by the point half a turn around the axis, where that one faces it. Half of the samples of a tube would be lost otherwise.
#pragma once
#include "base/matrix.h"
#include "geometry/shape.h"

namespace alpenglow::world {

/// The axis of one shape.
class HalfTurn {
public:
    /// Whether samples of a shape can be turned: a complete quadric that rays hit exactly and that does not move. Complete
    /// spheres have a better way (Emitter).
    static bool has(const geometry::Shape&);
    explicit HalfTurn(const geometry::Shape&);
    /// Which side light leaves from: 1: that of the normal, -1: the opposite one, 0: both.
    void shinesTo(int side);
    /// Whether a sample at (u, v) of the shape, both in [0, 1), has to be replaced by the one at (turned(u), v).
    bool turns(const geometry::SurfacePoint&, const Vec3& from, float u) const;
    static float turned(float u) { return u < .5f ? u + .5f : u - .5f; }
    /// Density of the samples that result, relative to that of the shape's own samples: 0 to 2.
    double factor(const geometry::SurfacePoint&, const Vec3& from) const;

private:
    bool faces(const Vec3d& P, const Vec3d& n, const Vec3& from) const { return dot(n, Vec3d(from) - P) * side_ > 0; }
    bool facesTurned(const geometry::SurfacePoint&, const Vec3& from) const;
    Matrix turn_;      ///< camera space: the half turn around the axis, its own inverse
    int outward_;      ///< side of the normal, or -1, that is outside
    int side_ = 1;     ///< as outward_: the side that counts as facing
    float chance_ = 1; ///< probability of a replacement where there may be one: 1 where nothing is seen of the other side
};

} // namespace alpenglow::world

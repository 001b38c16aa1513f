// Equations of quadrics, for testing many rays at once.
#pragma once
#include "base/vec.h"
#include <optional>

namespace alpenglow::geometry {

class Shape;

/// The equation for hits of a ray with a quadric. Shape::exactHits() computes the same in this order and in double: if this has
/// no root, it finds no hit.
struct QuadricForm {
    /// Which equation, and for which surfaces.
    enum class Kind {
        Ball,      ///< |P - centre| = radius, camera space
        Quadratic, ///< x^2 + y^2 + zz z^2 + z1 z + c = 0, object space
        Plane,     ///< z = height, object space
        Ring ///< any surface in a ring about z, object space: the line must enter its ball, its slab, and not all in the hole
    } kind;
    double toObject[4][3];    ///< from camera space, rows; all but Ball
    double middle;            ///< of the surface, on the z axis: lines are measured from the point nearest to it
    double zz, z1, c, height; ///< of Quadratic; height of Plane
    Vec3d centre;             ///< of a ball
    double radius;            ///< of a ball
    /// Ring: largest radius; relative to it half its height, the hole's radius, and the tolerance of both
    double size, high, hole, room;
};

/// None: no quadric, or one that a perspective distorts.
std::optional<QuadricForm> quadricForm(const Shape&);

} // namespace alpenglow::geometry

// The equations of quadrics, for who looks at many lines at once.
#pragma once
#include "base/vec.h"
#include <optional>

namespace alpenglow::geometry {

class Shape;

/// What the hits of a line with a quadric solve. Shape::exactHits() computes the same, in this order and in double: a line for
/// which this has no root is one that it finds no hit for.
struct QuadricForm {
    enum class Kind {
        Ball,      ///< |P - centre| = radius, camera space
        Quadratic, ///< x^2 + y^2 + zz z^2 + z1 z + c = 0, object space
        Plane,     ///< z = height, object space
        Torus      ///< object space; the line must pass the bounds of Torus::clip()
    } kind;
    double toObject[4][3]; ///< from camera space, rows; all but Ball
    double middle;         ///< of the surface, on the z axis: lines are measured from the point nearest to it
    double zz, z1, c, height;
    Vec3d centre;
    double radius;                 ///< of a ball
    double size, high, hole, room; ///< Torus: its greatest radius; by it half its height, the hole's radius, and the room of both
};

/// None: no quadric, or one that a perspective distorts.
std::optional<QuadricForm> quadricForm(const Shape&);

} // namespace alpenglow::geometry

// 4x4 matrices in the RenderMan convention: row vectors, p' = p * M, translation in the last row.
// Source: RISpec 3.2, 4.3. Double, because transforms compose (docs/design/decisions.md, "Current space").
#pragma once
#include "base/vec.h"

namespace alpenglow {

/// m[row][column]; the identity by default.
struct Matrix {
    double m[4][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    friend bool operator==(const Matrix& a, const Matrix& b);
};

/// a * b: a is applied first (row vectors).
Matrix operator*(const Matrix& a, const Matrix& b);
/// Inverse; identity and *singular = true when the determinant is 0 or not finite.
Matrix inverse(const Matrix& a, bool* singular = nullptr);
/// Of all four rows.
double determinant(const Matrix& a);
/// Sign of the determinant of the upper 3x3: negative = the transform swaps handedness.
double determinant3(const Matrix& a);

/// p' = p + (x, y, z).
Matrix translateMatrix(double x, double y, double z);
/// p' = (x p.x, y p.y, z p.z).
Matrix scaleMatrix(double x, double y, double z);
/// Rotation by degrees about an axis through the origin; +z: x' = x cos - y sin, y' = x sin + y cos.
Matrix rotateMatrix(double degrees, double x, double y, double z);
/// RiSkew: shifts points along d2 so that d1 turns by degrees toward d2.
Matrix skewMatrix(double degrees, Vec3d d1, Vec3d d2);
/// RiPerspective: x' = x/(z t), y' = y/(z t), z' = (z-1)/z, t = tan(fov/2), fov in degrees.
Matrix perspectiveMatrix(double fovDegrees);

/// Point with homogeneous divide when w != 1.
Vec3d transformPoint(const Matrix& m, Vec3d p);
/// Direction: upper 3x3 only.
Vec3d transformVector(const Matrix& m, Vec3d v);
/// Normal by the inverse transpose of the upper 3x3; not normalised.
Vec3d transformNormal(const Matrix& m, Vec3d n);

} // namespace alpenglow

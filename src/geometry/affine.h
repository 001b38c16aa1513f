// Affine transforms in double, as rays and hits go through them.
#pragma once
#include "base/matrix.h"
#include <cmath>

namespace alpenglow::geometry {

/// p' = p.x x + p.y y + p.z z + o.
struct Affine {
    Vec3d x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, o{0, 0, 0};

    Affine() = default;
    /// a: without perspective; its last column is ignored.
    explicit Affine(const Matrix& a)
        : x(a.m[0][0], a.m[0][1], a.m[0][2]), y(a.m[1][0], a.m[1][1], a.m[1][2]), z(a.m[2][0], a.m[2][1], a.m[2][2]),
          o(a.m[3][0], a.m[3][1], a.m[3][2]) {}
    /// The image of a direction: without the translation.
    Vec3d vector(const Vec3d& v) const { return x * v.x + y * v.y + z * v.z; }
    /// The image of a point.
    Vec3d point(const Vec3d& p) const { return vector(p) + o; }
    /// v times the transpose of the 3x3 part. Of the inverse: a normal.
    Vec3d across(const Vec3d& v) const { return {dot(x, v), dot(y, v), dot(z, v)}; }
    /// Of the 3x3 part.
    double determinant() const { return dot(cross(x, y), z); }
    /// Returns false if there is none.
    bool inverse(Affine& out) const {
        const Vec3d a = cross(y, z), b = cross(z, x), c = cross(x, y);
        const double i = 1 / dot(a, x);
        if (!std::isfinite(i)) return false;
        out.x = Vec3d(a.x, b.x, c.x) * i;
        out.y = Vec3d(a.y, b.y, c.y) * i;
        out.z = Vec3d(a.z, b.z, c.z) * i;
        out.o = -out.vector(o);
        return true;
    }
    /// Linear, element by element: a at w = 0, b at w = 1.
    static Affine between(const Affine& a, const Affine& b, double w) {
        const double v = 1 - w;
        Affine r;
        r.x = a.x * v + b.x * w;
        r.y = a.y * v + b.y * w;
        r.z = a.z * v + b.z * w;
        r.o = a.o * v + b.o * w;
        return r;
    }
    /// Largest column sum of absolute values: |vector(v)| is at most this times the largest |v| component.
    double stretch() const {
        const auto sum = [&](int k) { return std::fabs(x[k]) + std::fabs(y[k]) + std::fabs(z[k]); };
        return std::fmax(sum(0), std::fmax(sum(1), sum(2)));
    }
};

} // namespace alpenglow::geometry

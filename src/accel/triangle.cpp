#include "accel/accel.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::accel {

bool meetTriangle(const Vec3& org, const Vec3& dir, const Vec3& fa, const Vec3& fb, const Vec3& fc, double& t, double& b1,
                  double& b2, double& outside) {
    // Float coordinates subtract exactly or nearly so in double: the plane test keeps the side of an origin one float step away.
    Vec3d a = Vec3d(fa) - Vec3d(org), b = Vec3d(fb) - Vec3d(org), c = Vec3d(fc) - Vec3d(org), d(dir);
    Vec3d e1 = b - a, e2 = c - a, n = cross(e1, e2);
    double den = dot(n, d);
    if (!(std::fabs(den) > 0)) return false;
    t = dot(n, a) / den;
    // Moeller-Trumbore weights, relative to corner a.
    Vec3d q = cross(a, d);
    b1 = dot(q, e2) / den;
    b2 = -dot(q, e1) / den;
    if (!std::isfinite(t) || !std::isfinite(b1) || !std::isfinite(b2)) return false;
    outside = std::max({0.0, -b1, -b2, b1 + b2 - 1});
    b1 = std::clamp(b1, 0.0, 1.0);
    b2 = std::clamp(b2, 0.0, 1.0);
    if (b1 + b2 > 1) {
        double s = b1 + b2;
        b1 /= s;
        b2 /= s;
    }
    return true;
}

} // namespace alpenglow::accel

// The ground of a Blobby: a depth map that repels (Pixar's application note 31).
#include "geometry/blob_leaf.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

double BlobGround::above(const Vec3d& p) const {
    const auto& s = toScreen.m;
    const double w = p.x * s[0][3] + p.y * s[1][3] + p.z * s[2][3] + s[3][3];
    if (!(w > 0)) return INFINITY;
    const double x = (p.x * s[0][0] + p.y * s[1][0] + p.z * s[2][0] + s[3][0]) / w,
                 y = (p.x * s[0][1] + p.y * s[1][1] + p.z * s[2][1] + s[3][1]) / w;
    const double i = (0.5 + 0.5 * x) * width - 0.5, j = (0.5 - 0.5 * y) * height - 0.5;
    if (!(i >= -0.5 && i <= width - 0.5 && j >= -0.5 && j <= height - 0.5)) return INFINITY;
    const int i0 = std::clamp(int(std::floor(i)), 0, std::max(0, width - 2)),
              j0 = std::clamp(int(std::floor(j)), 0, std::max(0, height - 2));
    const int i1 = std::min(i0 + 1, width - 1), j1 = std::min(j0 + 1, height - 1);
    const double u = std::clamp(i - i0, 0.0, 1.0), v = std::clamp(j - j0, 0.0, 1.0);
    const auto at = [&](int x0, int y0) { return double(depth[size_t(y0) * size_t(width) + size_t(x0)]); };
    const double z = (1 - v) * ((1 - u) * at(i0, j0) + u * at(i1, j0)) + v * ((1 - u) * at(i0, j1) + u * at(i1, j1));
    return z - transformPoint(toCamera, p).z;
}

namespace {

/// As in the application note: a wall at height 0, a bulge around height c, zero from a on.
double repulsion(double z, const BlobGround& g) {
    if (!(z < g.a)) return 0;
    z = std::max(z, 1e-6);
    const double r = z / g.c, e = std::clamp(z / g.a, 0.0, 1.0);
    const double bump = r > 0 && r < 2 ? (((6 - r) * r - 12) * r + 8) * r * r * r : 0;
    return (g.d * bump - g.b / z) * (1 - e * e * (3 - 2 * e));
}

} // namespace

double blobGroundField(const BlobGround& g, const Vec3d& p) { return repulsion(g.above(p), g); }

/// By differences with a step smaller than the map's detail: depth maps have no derivatives.
BlobJet blobGroundJet(const BlobGround& g, const Vec3d& p) {
    BlobJet j;
    j.f = blobGroundField(g, p);
    const double step = 1e-4 * std::max(g.a, 1e-9);
    for (int k = 0; k < 3; ++k) {
        Vec3d a = p, b = p;
        a[k] += step, b[k] -= step;
        const double fa = blobGroundField(g, a), fb = blobGroundField(g, b);
        j.g[k] = (fa - fb) / (2 * step);
        j.h[k] = (fa - 2 * j.f + fb) / (step * step);
    }
    return j;
}

Interval blobGroundBounds(const BlobGround& g, const Vec3d& lo, const Vec3d& hi) {
    // Depths anywhere in the map: simple, and boxes get small.
    double near = INFINITY, far = -INFINITY;
    for (int k = 0; k < 8; ++k) {
        const double z = transformPoint(g.toCamera, Vec3d(k & 1 ? lo.x : hi.x, k & 2 ? lo.y : hi.y, k & 4 ? lo.z : hi.z)).z;
        near = std::min(near, z);
        far = std::max(far, z);
    }
    const double least = std::max(1e-6, g.least - far), most = std::max(1e-6, g.most - near);
    if (least >= g.a) return {0, 0};
    const double bulge = std::max(0.0, g.d), dent = std::min(0.0, g.d);
    return {dent - std::max(0.0, g.b) / least, bulge + std::max(0.0, -g.b) / std::min(least, most)};
}

} // namespace alpenglow::geometry

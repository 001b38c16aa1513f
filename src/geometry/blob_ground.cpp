// The ground of a Blobby: a depth map that repels (Pixar's application note 31).
#include "geometry/blob_leaf.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

double BlobGround::depthAt(double i, double j) const {
    const int i0 = std::clamp(int(std::floor(i)), 0, std::max(0, width - 2)),
              j0 = std::clamp(int(std::floor(j)), 0, std::max(0, height - 2));
    const int i1 = std::min(i0 + 1, width - 1), j1 = std::min(j0 + 1, height - 1);
    const double u = std::clamp(i - i0, 0.0, 1.0), v = std::clamp(j - j0, 0.0, 1.0);
    const auto at = [&](int x0, int y0) { return double(depth[size_t(y0) * size_t(width) + size_t(x0)]); };
    return (1 - v) * ((1 - u) * at(i0, j0) + u * at(i1, j0)) + v * ((1 - u) * at(i0, j1) + u * at(i1, j1));
}

void BlobGround::sumUp() {
    levels.assign(1, {});
    for (const float z : depth) levels[0].push_back({z, z});
    for (int w = width, h = height; w > 1 || h > 1;) {
        const std::vector<Range>& fine = levels.back();
        const int half = (w + 1) / 2, rows = (h + 1) / 2;
        std::vector<Range> coarse(size_t(half) * size_t(rows), {INFINITY, -INFINITY});
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const Range& r = fine[size_t(y) * size_t(w) + size_t(x)];
                Range& all = coarse[size_t(y / 2) * size_t(half) + size_t(x / 2)];
                all = {std::min(all.least, r.least), std::max(all.most, r.most)};
            }
        levels.push_back(std::move(coarse));
        w = half, h = rows;
    }
}

BlobGround::Range BlobGround::range(int x0, int y0, int x1, int y1) const {
    size_t level = 0;
    int w = width;
    for (; level + 1 < levels.size() && (x1 - x0 > 1 || y1 - y0 > 1); ++level)
        x0 /= 2, y0 /= 2, x1 /= 2, y1 /= 2, w = (w + 1) / 2;
    Range all{INFINITY, -INFINITY};
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const Range& r = levels[level][size_t(y) * size_t(w) + size_t(x)];
            all = {std::min(all.least, r.least), std::max(all.most, r.most)};
        }
    return all;
}

double BlobGround::above(const Vec3d& p) const {
    const auto& s = toScreen.m;
    const double w = p.x * s[0][3] + p.y * s[1][3] + p.z * s[2][3] + s[3][3];
    if (!(w > 0)) return INFINITY;
    const double x = (p.x * s[0][0] + p.y * s[1][0] + p.z * s[2][0] + s[3][0]) / w,
                 y = (p.x * s[0][1] + p.y * s[1][1] + p.z * s[2][1] + s[3][1]) / w;
    const double i = (0.5 + 0.5 * x) * width - 0.5, j = (0.5 - 0.5 * y) * height - 0.5;
    if (!(i >= -0.5 && i <= width - 0.5 && j >= -0.5 && j <= height - 0.5)) return INFINITY;
    return depthAt(i, j) - transformPoint(toCamera, p).z;
}

namespace {

/// (2 - r)^3 r^3 between 0 and 2.
double bump(double r) { return r > 0 && r < 2 ? (((6 - r) * r - 12) * r + 8) * r * r * r : 0; }

/// As in the application note: a wall at height 0, a bulge around height c, zero from a on.
double repulsion(double z, const BlobGround& g) {
    if (!(z < g.a)) return 0;
    z = std::max(z, 1e-6);
    const double e = std::clamp(z / g.a, 0.0, 1.0);
    return (g.d * bump(z / g.c) - g.b / z) * (1 - e * e * (3 - 2 * e));
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

namespace {

/// Of repulsion() for heights from z0 to z1.
Interval repulsionBounds(double z0, double z1, const BlobGround& g) {
    if (!(z0 < g.a)) return {0, 0};
    z0 = std::max(z0, 1e-6), z1 = std::clamp(z1, z0, g.a);
    double r0 = z0 / g.c, r1 = z1 / g.c;
    if (r0 > r1) std::swap(r0, r1);
    const Interval rise{std::min(bump(r0), bump(r1)), r0 < 1 && r1 > 1 ? 1 : std::max(bump(r0), bump(r1))};
    const auto left = [&](double z) { return 1 - z / g.a * (z / g.a) * (3 - 2 * z / g.a); };
    const Interval a = multiply({g.d, g.d}, rise), b = multiply({g.b, g.b}, {1 / z1, 1 / z0});
    return multiply({a.lo - b.hi, a.hi - b.lo}, {left(z1), left(z0)});
}

} // namespace

Interval blobGroundBounds(const BlobGround& g, const Vec3d& lo, const Vec3d& hi) {
    double near = INFINITY, far = -INFINITY, i0 = INFINITY, i1 = -INFINITY, j0 = INFINITY, j1 = -INFINITY;
    const auto& s = g.toScreen.m;
    for (int k = 0; k < 8; ++k) {
        const Vec3d p(k & 1 ? lo.x : hi.x, k & 2 ? lo.y : hi.y, k & 4 ? lo.z : hi.z);
        const double z = transformPoint(g.toCamera, p).z, w = p.x * s[0][3] + p.y * s[1][3] + p.z * s[2][3] + s[3][3];
        near = std::min(near, z), far = std::max(far, z);
        double i = (0.5 + 0.5 * (p.x * s[0][0] + p.y * s[1][0] + p.z * s[2][0] + s[3][0]) / w) * g.width - 0.5;
        double j = (0.5 - 0.5 * (p.x * s[0][1] + p.y * s[1][1] + p.z * s[2][1] + s[3][1]) / w) * g.height - 0.5;
        i0 = w > 0 ? std::min(i0, i) : -INFINITY, i1 = w > 0 ? std::max(i1, i) : INFINITY;
        j0 = w > 0 ? std::min(j0, j) : -INFINITY, j1 = w > 0 ? std::max(j1, j) : INFINITY;
        if (!(w > 0)) k = 7, near = -INFINITY, far = INFINITY; // a part of it may lie anywhere
    }
    const double right = g.width - 0.5, bottom = g.height - 0.5, slack = 1e-9; // of rounding
    if (i1 < -0.5 - slack || i0 > right + slack || j1 < -0.5 - slack || j0 > bottom + slack) return {0, 0};
    const bool outside = !(i0 > -0.5 + slack && i1 < right - slack && j0 > -0.5 + slack && j1 < bottom - slack);
    const auto inMap = [](double x, int side) { return std::clamp(x, 0.0, double(side - 1)); };
    i0 = inMap(i0, g.width), i1 = inMap(i1, g.width), j0 = inMap(j0, g.height), j1 = inMap(j1, g.height);
    double least = INFINITY, most = -INFINITY;
    if (std::floor(i1) <= std::floor(i0) + 1 &&
        std::floor(j1) <= std::floor(j0) + 1) { // corners of parts in cells are the extremes
        for (const double j : {j0, std::min(std::floor(j0) + 1, j1), j1})
            for (const double i : {i0, std::min(std::floor(i0) + 1, i1), i1}) {
                const double z = g.depthAt(i, j);
                least = std::min(least, z), most = std::max(most, z);
            }
    } else {
        const auto r = g.range(int(i0), int(j0), std::min(int(i1) + 1, g.width - 1), std::min(int(j1) + 1, g.height - 1));
        least = r.least, most = r.most;
    }
    Interval field = repulsionBounds(least - far - 1e-12 * (1 + std::fabs(far)), most - near + 1e-12 * (1 + std::fabs(near)), g);
    if (outside) field = {std::min(field.lo, 0.0), std::max(field.hi, 0.0)};
    return field;
}

} // namespace alpenglow::geometry

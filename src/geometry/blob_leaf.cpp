// The fields of ellipsoids and segments, with derivatives and bounds.
#include "geometry/blob_leaf.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

constexpr double kWhole = 35.0 / 32; ///< 1 over the integral of (1 - t^2)^3: an endless segment is 1 on its axis

} // namespace

Vec3d BlobLeaf::inside(const Vec3d& p) const {
    return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3], m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
            m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

double blobLeafField(const BlobLeaf& l, const Vec3d& q, Vec3d* g, double* h) {
    if (g) *g = Vec3d(0.0);
    if (h) std::fill(h, h + 6, 0.0);
    if (l.kind == BlobLeaf::Kind::Ellipsoid) { // (1 - r^2)^3
        const double k = 1 - dot(q, q);
        if (k <= 0) return 0;
        if (g) *g = q * (-6 * k * k);
        if (h) {
            const double a = -6 * k * k, b = 24 * k;
            h[0] = a + b * q.x * q.x, h[1] = a + b * q.y * q.y, h[2] = a + b * q.z * q.z;
            h[3] = b * q.x * q.y, h[4] = b * q.x * q.z, h[5] = b * q.y * q.z;
        }
        return cube(k);
    }
    // The same bump, integrated along the segment: segments end to end add up to the longer one.
    const Vec3d e = q - l.from;
    const double s = dot(e, l.along);
    const Vec3d side = e - l.along * s;
    const double k = 1 - dot(side, side);
    if (k <= 0) return 0;
    const double reach = std::sqrt(k), lo = std::max(-s, -reach), hi = std::min(l.length - s, reach);
    if (lo >= hi) return 0;
    const auto between = [&](auto f) { return kWhole * (f(hi) - f(lo)); };
    const double value = between([&](double u) {
        const double v = u * u;
        return u * (k * k * k - v * (k * k - v * (0.6 * k - v / 7)));
    });
    if (!g) return value;
    const double byK = between([&](double u) {
        const double v = u * u;
        return u * (3 * k * k - v * (2 * k - 0.6 * v));
    });
    const double begin = std::max(0.0, k - s * s), end = std::max(0.0, k - (l.length - s) * (l.length - s));
    const double byS = kWhole * (cube(begin) - cube(end));
    *g = side * (-2 * byK) + l.along * byS;
    if (!h) return value;
    const double kk = between([&](double u) { return u * (6 * k - 2 * u * u); });
    const double ks = kWhole * 3 * (begin * begin - end * end);
    const double ss = kWhole * -6 * ((l.length - s) * end * end + s * begin * begin);
    const Vec3d gk = side * -2.0, &a = l.along;
    const auto term = [&](int i, int j) {
        return kk * gk[i] * gk[j] + ks * (gk[i] * a[j] + gk[j] * a[i]) + ss * a[i] * a[j] - 2 * byK * ((i == j) - a[i] * a[j]);
    };
    h[0] = term(0, 0), h[1] = term(1, 1), h[2] = term(2, 2), h[3] = term(0, 1), h[4] = term(0, 2), h[5] = term(1, 2);
    return value;
}

double blobLeafValue(const BlobLeaf& l, const Vec3d& p) {
    return l.kind == BlobLeaf::Kind::Ground ? blobGroundField(*l.ground, p) : blobLeafField(l, l.inside(p), nullptr, nullptr);
}

BlobJet blobLeafJet(const BlobLeaf& l, const Vec3d& p) {
    if (l.kind == BlobLeaf::Kind::Ground) return blobGroundJet(*l.ground, p);
    Vec3d g;
    double h[6];
    BlobJet r;
    r.f = blobLeafField(l, l.inside(p), &g, h);
    if (r.f == 0) return r;
    const double full[3][3] = {{h[0], h[3], h[4]}, {h[3], h[1], h[5]}, {h[4], h[5], h[2]}};
    for (int j = 0; j < 3; ++j) r.g[j] = g.x * l.m[0][j] + g.y * l.m[1][j] + g.z * l.m[2][j];
    for (int k = 0; k < 6; ++k)
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b) r.h[k] += l.m[a][kBlobJetRow[k]] * full[a][b] * l.m[b][kBlobJetColumn[k]];
    return r;
}

Interval blobLeafBounds(const BlobLeaf& l, const Vec3d& lo, const Vec3d& hi) {
    if (l.kind == BlobLeaf::Kind::Ground) return blobGroundBounds(*l.ground, lo, hi);
    if (lo.x > l.hi.x || hi.x < l.lo.x || lo.y > l.hi.y || hi.y < l.lo.y || lo.z > l.hi.z || hi.z < l.lo.z) return {0, 0};
    const Vec3d q = l.inside((lo + hi) * 0.5), half = (hi - lo) * 0.5;
    double near = 0, far = 0, reach = 0;
    for (int i = 0; i < 3; ++i) {
        const double e = std::fabs(l.m[i][0]) * half.x + std::fabs(l.m[i][1]) * half.y + std::fabs(l.m[i][2]) * half.z +
                         1e-14 * (1 + std::fabs(q[i]));
        const double a = std::fabs(q[i]), b = std::max(0.0, a - e);
        near += b * b;
        far += (a + e) * (a + e);
        reach += e * e;
    }
    if (l.kind == BlobLeaf::Kind::Ellipsoid) return {cube(std::max(0.0, 1 - far)), cube(std::max(0.0, 1 - near))};
    reach = std::sqrt(reach);
    const Vec3d e = q - l.from;
    const double distance = length(e - l.along * std::clamp(dot(e, l.along), 0.0, l.length));
    if (distance - reach >= 1) return {0, 0};
    const double f = blobLeafField(l, q, nullptr, nullptr);
    return {std::max(0.0, f - kBlobSegmentSlope * reach), std::min(1.0, f + kBlobSegmentSlope * reach)};
}

} // namespace alpenglow::geometry

// Rays against curves.
#include "base/exact.h"
#include "geometry/curves.h"
#include "geometry/solve.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {
constexpr double kEdge = 1e-9; // of a segment, or of the width: neighbours reach that far into each other
}

CurveRay::CurveRay(const Vec3d& o, const Vec3d& d, const Vec3d& near, double from, double to) : lo(from), hi(to) {
    const double dd = dot(d, d);
    length = std::sqrt(dd);
    e3 = d / length;
    acrossFrame(e3, e1, e2);
    // From the point nearest the segment: a far origin would swallow its width.
    shift = dot(near - o, d) / dd;
    org = o + d * shift;
}

namespace {

/// Whether a ray along z passes a box around points by no more than `reach`, between lo and hi.
bool passesBy(const CurveRay& r, const Vec3d* p, int n, double reach) {
    double x0 = p[0].x, x1 = x0, y0 = p[0].y, y1 = y0, z0 = p[0].z, z1 = z0;
    for (int i = 1; i < n; ++i) {
        x0 = std::min(x0, p[i].x), x1 = std::max(x1, p[i].x);
        y0 = std::min(y0, p[i].y), y1 = std::max(y1, p[i].y);
        z0 = std::min(z0, p[i].z), z1 = std::max(z1, p[i].z);
    }
    return x0 <= reach && x1 >= -reach && y0 <= reach && y1 >= -reach && r.t(z1 + reach) >= r.lo && r.t(z0 - reach) <= r.hi;
}

/// Keeps the four nearest.
void keep(const CurveRay& r, CurveHit out[4], int& n, const CurveHit& h) {
    if (!(h.t > r.lo && h.t <= r.hi)) return;
    if (n < 4) {
        out[n++] = h;
        return;
    }
    CurveHit* far = std::max_element(out, out + 4, [](const CurveHit& a, const CurveHit& b) { return a.t < b.t; });
    if (h.t < far->t) *far = h;
}

int intersectFlatLine(const CurveSegment& g, double from, double to, const CurveFacing& face, const CurveRay& r,
                      CurveHit out[4]) {
    const Vec3d c0 = r.placed(g.p[1]), c1 = r.placed(g.p[2]);
    const Vec3d ends[2] = {c0, c1};
    if (!passesBy(r, ends, 2, 2 * g.widest())) return 0; // mitres reach twice as far
    const Vec3d w0 = r.turned(sideAt(g, face, 0).f), w1 = r.turned(sideAt(g, face, 1).f);
    const auto area = [](const Vec3d& a, const Vec3d& b) { return a.x * b.y - a.y * b.x; };
    // Offset of the line from the centre, along the side vector.
    double c[3] = {area(c0, w0), 0.5 * (area(c0, w1) + area(c1, w0)), area(c1, w1)};
    double roots[8];
    const int count = bernsteinRoots(c, 2, roots);
    int n = 0;
    for (int i = 0; i < count; ++i) {
        const double f = roots[i];
        if (f < from - kEdge || f > to + kEdge) continue;
        const Vec3d p = c0 + (c1 - c0) * f, w = w0 + (w1 - w0) * f;
        const double ww = w.x * w.x + w.y * w.y;
        if (!(ww > 0)) continue;
        const double s = -(p.x * w.x + p.y * w.y) / ww;
        if (!(std::fabs(s) <= 1 + kEdge)) continue;
        const double clamped = std::clamp(s, -1.0, 1.0);
        keep(r, out, n, {r.t(p.z + clamped * w.z), clamped, f, r.e1 * w.x + r.e2 * w.y + r.e3 * w.z});
    }
    return n;
}

} // namespace

int intersectRibbon(const CurveSegment& g, double from, double to, const CurveFacing& face, bool fromRay, const CurveRay& r,
                    CurveHit out[4]) {
    if (g.linear) return intersectFlatLine(g, from, to, face, r, out);
    Vec3d p[4];
    for (int i = 0; i < 4; ++i) p[i] = r.placed(g.p[i]);
    if (!passesBy(r, p, 4, g.widest())) return 0;
    double h[4];
    std::copy(g.h, g.h + 4, h);
    const bool part = from > 0 || to < 1;
    if (part) {
        bernsteinPart<3>(p, from, to);
        bernsteinPart<3>(h, from, to);
        if (!passesBy(r, p, 4, g.widest())) return 0;
    }
    Vec3d d[3];
    bernsteinSlope<3>(p, d);
    double x[4], y[4], dx[3], dy[3], dz[3];
    for (int i = 0; i < 4; ++i) x[i] = p[i].x, y[i] = p[i].y;
    for (int i = 0; i < 3; ++i) dx[i] = d[i].x, dy[i] = d[i].y, dz[i] = d[i].z;
    // The ribbon's side vector is along b = dC/df ^ N; the ray hits its line where C and b are parallel as seen along the ray.
    double roots[8], c[kBernsteinMost + 1] = {}, bx[6] = {}, by[6] = {}, bz[6] = {};
    int count = 0;
    if (fromRay) {
        bernsteinAddProduct<3, 2>(c, x, dx);
        bernsteinAddProduct<3, 2>(c, y, dy);
        count = bernsteinRoots(c, 5, roots);
    } else {
        Vec3d n[4];
        for (int i = 0; i < 4; ++i)
            n[i] = face.kind == CurveFacing::Point   ? r.placed(face.at) - r.placed(g.p[i])
                   : face.kind == CurveFacing::Given ? r.turned(g.n[i])
                                                     : r.turned(face.at);
        if (part) bernsteinPart<3>(n, from, to);
        double nx[4], ny[4], nz[4];
        for (int i = 0; i < 4; ++i) nx[i] = n[i].x, ny[i] = n[i].y, nz[i] = n[i].z;
        const auto product = [](double* out, const double* n1, const double* d1, const double* n2, const double* d2) {
            bernsteinAddProduct<3, 2>(out, n1, d1);
            bernsteinAddProduct<3, 2>(out, n2, d2, -1);
        };
        product(bx, nz, dy, ny, dz);
        product(by, nx, dz, nz, dx);
        product(bz, ny, dx, nx, dy);
        bernsteinAddProduct<3, 5>(c, x, by);
        bernsteinAddProduct<3, 5>(c, y, bx, -1);
        count = bernsteinRoots(c, 8, roots);
    }
    int n = 0;
    for (int i = 0; i < count; ++i) {
        const double f = roots[i], half = bernsteinAt<3>(h, f);
        if (!(half > 0)) continue;
        const Vec3d at = bernsteinAt<3>(p, f);
        Vec3d b;
        if (fromRay) {
            const Vec3d along = bernsteinAt<2>(d, f);
            b = {-along.y, along.x, 0};
        } else b = {bernsteinAt<5>(bx, f), bernsteinAt<5>(by, f), bernsteinAt<5>(bz, f)};
        b = normalize(b) * face.side;
        const double bb = b.x * b.x + b.y * b.y;
        if (!(bb > 0)) continue;
        const double s = -(at.x * b.x + at.y * b.y) / (bb * half);
        if (!(std::fabs(s) <= 1 + kEdge)) continue;
        const double clamped = std::clamp(s, -1.0, 1.0);
        keep(r, out, n,
             {r.t(at.z + clamped * half * b.z), clamped, from + (to - from) * f, r.e1 * b.x + r.e2 * b.y + r.e3 * b.z});
    }
    return n;
}

namespace {

/// Intersections of the ray, the z axis, with the infinite cone around p0 to p1, which are l apart; number of z. For a near miss
/// (`misses`), two values around the nearest approach.
int intersectCone(const Vec3d& p0, double h0, const Vec3d& p1, double h1, double l, double z[2], bool& misses) {
    misses = false;
    const Vec3d t = (p1 - p0) / l;
    const double k = (h1 - h0) / l, kk = 1 + k * k, at = dot(p0, t);
    const double a = 1 - kk * t.z * t.z, b = -p0.z + kk * t.z * at - h0 * k * t.z,
                 c = dot(p0, p0) - kk * at * at + 2 * h0 * k * at - h0 * h0;
    if (const int n = solveQuadratic(a, b, c, z)) return n;
    if (!(a > 0)) return 0;
    const double wide = std::max(h0, h1) / std::sqrt(a), gap = (c - b * b / a) / std::max(h0 * h0, h1 * h1);
    if (!(gap < 0.2)) return 0; // far from a silhouette
    misses = true;
    z[0] = -b / a - 0.2 * wide;
    z[1] = -b / a + 0.2 * wide;
    return 2;
}

int intersectRoundLine(const CurveSegment& g, const CurveRay& r, CurveHit out[4]) {
    const Vec3d a = r.placed(g.p[1]), b = r.placed(g.p[2]);
    const Vec3d ends[2] = {a, b};
    if (!passesBy(r, ends, 2, 2 * g.widest()) || a == b) return 0;
    double z[2];
    bool misses;
    const int roots = intersectCone(a, g.h[0], b, g.h[1], length(b - a), z, misses);
    const Vec3d along = normalize(b - a), before = normalize(a - r.placed(g.p[0])), behind = normalize(r.placed(g.p[3]) - b);
    // Bisecting planes with the neighbours; ends and turns of more than 120 degrees are cut straight.
    const Vec3d first = dot(before, along) > -0.5 ? along + before : along,
                second = dot(behind, along) > -0.5 ? along + behind : along;
    int n = 0;
    for (int i = 0; i < roots; ++i) {
        const Vec3d at(0, 0, z[i]);
        const double f = dot(at - a, along) / length(b - a), h = g.h[0] + (g.h[1] - g.h[0]) * f, reach = kEdge * g.widest();
        const Vec3d out1 = at - (a + (b - a) * f);
        if (!(h > 0) || !(std::fabs(dot(out1, out1) - h * h) <= 1e-9 * (h * h + dot(out1, out1)))) continue;
        if (dot(at - a, first) < -reach || dot(at - b, second) > reach) continue;
        keep(r, out, n, {r.t(z[i]), 0, f, {}});
    }
    return n;
}

} // namespace

namespace common {
#include "geometry/curve_tube.inc"
} // namespace common

#pragma clang attribute push(__attribute__((target("avx2,fma,bmi,bmi2"))), apply_to = function)
namespace avx2 {
#include "geometry/curve_tube.inc"
} // namespace avx2
#pragma clang attribute pop

int intersectTube(const CurveSegment& g, double from, double to, const CurveRay& r, CurveHit out[4], bool nearest, bool plain) {
    static const bool has = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                            __builtin_cpu_supports("bmi2");
    if (g.linear) return intersectRoundLine(g, r, out);
    return (has && !plain ? avx2::intersectTube : common::intersectTube)(g, from, to, r, out, nearest);
}

} // namespace alpenglow::geometry

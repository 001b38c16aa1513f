// Where the surface of a curve is: positions and frames along it, with exact derivatives.
#include "base/exact.h"
#include "geometry/curves.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

Jet cross(const Jet& a, const Jet& b) {
    return {cross(a.f, b.f), cross(a.d, b.f) + cross(a.f, b.d), cross(a.dd, b.f) + cross(a.d, b.d) * 2.0 + cross(a.f, b.dd)};
}

Jet operator*(const ScalarJet& s, const Jet& v) {
    return {v.f * s.f, v.f * s.d + v.d * s.f, v.f * s.dd + v.d * (2 * s.d) + v.dd * s.f};
}

Jet operator+(const Jet& a, const Jet& b) { return {a.f + b.f, a.d + b.d, a.dd + b.dd}; }

Jet unit(const Jet& v) {
    const double l = length(v.f);
    if (!(l > 0)) return {};
    const Vec3d u = v.f / l;
    const double ld = dot(u, v.d), ldd = (dot(v.d, v.d) + dot(v.f, v.dd) - ld * ld) / l;
    const Vec3d d = (v.d - u * ld) / l;
    return {u, d, (v.dd - d * (2 * ld) - u * ldd) / l};
}

double CurveSegment::widest() const {
    return linear ? std::max(h[0], h[1]) : std::max(std::max(h[0], h[1]), std::max(h[2], h[3]));
}

void acrossFrame(const Vec3d& along, Vec3d& a, Vec3d& b) {
    // Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017.
    const Vec3d n = normalize(along);
    const double sign = std::copysign(1.0, n.z), k = -1 / (sign + n.z), m = n.x * n.y * k;
    a = {1 + sign * n.x * n.x * k, sign * m, -sign * n.x};
    b = {m, sign + n.y * n.y * k, -n.y};
}

namespace {

/// The first three derivatives of a cubic, and its value.
struct Cubic {
    Vec3d f, d, dd, ddd;
};
Cubic cubicAt(const Vec3d p[4], double x) {
    Vec3d d[3], dd[2];
    bernsteinSlope<3>(p, d);
    bernsteinSlope<2>(d, dd);
    return {bernsteinAt<3>(p, x), bernsteinAt<2>(d, x), bernsteinAt<1>(dd, x), dd[1] - dd[0]};
}

ScalarJet halfWidthAt(const CurveSegment& g, double f) {
    if (g.linear) return {g.h[0] + (g.h[1] - g.h[0]) * f, g.h[1] - g.h[0], 0};
    double d[3], dd[2];
    bernsteinSlope<3>(g.h, d);
    bernsteinSlope<2>(d, dd);
    const double h = bernsteinAt<3>(g.h, f);
    if (h < 0) return {};
    return {h, bernsteinAt<2>(d, f), bernsteinAt<1>(dd, f)};
}

/// The tangent of a cubic; if points coincide at an end, that of the next ones.
Jet directionAt(const CurveSegment& g, const Cubic& c) {
    if (dot(c.d, c.d) > 0) return {c.d, c.dd, c.ddd};
    if (dot(c.dd, c.dd) > 0) return {c.dd, c.ddd, {}};
    return {g.p[3] - g.p[0], {}, {}};
}

} // namespace

Jet curveAt(const CurveSegment& g, double f) {
    if (g.linear) return {g.p[1] + (g.p[2] - g.p[1]) * f, g.p[2] - g.p[1], {}};
    const Cubic c = cubicAt(g.p, f);
    return {c.f, c.d, c.dd};
}

/// The side vector of a linear ribbon at an end: mitred with the neighbour, whose vector is the same; ends and turns of more than
/// 120 degrees are cut straight.
static Vec3d mitred(const CurveSegment& g, const CurveFacing& face, bool end) {
    const Vec3d corner = end ? g.p[2] : g.p[1];
    const Vec3d n = face.kind == CurveFacing::Point ? face.at - corner : face.kind == CurveFacing::Given ? g.n[end] : face.at;
    const Vec3d own = normalize(cross(g.p[2] - g.p[1], n));
    const Vec3d other = normalize(cross(end ? g.p[3] - g.p[2] : g.p[1] - g.p[0], n));
    const double cosine = dot(own, other);
    const Vec3d side = dot(other, other) > 0 && cosine > -0.5 ? (own + other) / (1 + cosine) : own;
    return side * (face.side * g.h[end]);
}

Jet sideAt(const CurveSegment& g, const CurveFacing& face, double f) {
    if (g.linear) {
        const Vec3d a = mitred(g, face, false), b = mitred(g, face, true);
        return {a + (b - a) * f, b - a, {}};
    }
    const Cubic c = cubicAt(g.p, f);
    const Jet along = directionAt(g, c);
    Jet n{face.at, {}, {}};
    if (face.kind == CurveFacing::Point) n = {face.at - c.f, -c.d, -c.dd};
    if (face.kind == CurveFacing::Given) {
        const Cubic given = cubicAt(g.n, f);
        n = {given.f, given.d, given.dd};
    }
    ScalarJet h = halfWidthAt(g, f);
    h.f *= face.side, h.d *= face.side, h.dd *= face.side;
    return h * unit(cross(along, n));
}

void tubeFrame(const CurveSegment& g, double f, Jet& first, Jet& second, ScalarJet& radius) {
    const Jet along = g.linear ? Jet{g.p[2] - g.p[1], {}, {}} : unit(directionAt(g, cubicAt(g.p, f)));
    first = unit(cross(along, Jet{g.axis, {}, {}}));
    if (!(dot(first.f, first.f) > 0)) { // along the axis
        Vec3d a, b;
        acrossFrame(along.f, a, b);
        first = {a, {}, {}};
    }
    second = unit(cross(along, first));
    radius = halfWidthAt(g, f);
}

void tubeEnd(const CurveSegment& g, bool end, Vec3d& centre, Vec3d& axis, double& radius) {
    centre = curveAt(g, end).f;
    axis = normalize(g.linear ? g.p[2] - g.p[1] : directionAt(g, cubicAt(g.p, end)).f);
    radius = halfWidthAt(g, end).f;
}

double tubeAngle(const CurveSegment& g, double f, const Vec3d& point) {
    Vec3d along = g.p[2] - g.p[1], centre = g.p[1] + along * f;
    if (!g.linear) {
        Vec3d d[3];
        bernsteinSlope<3>(g.p, d);
        centre = bernsteinAt<3>(g.p, f);
        along = bernsteinAt<2>(d, f);
        if (!(dot(along, along) > 0)) along = directionAt(g, cubicAt(g.p, f)).f;
    }
    const Vec3d unit = normalize(along);
    Vec3d first = cross(unit, g.axis), second;
    if (dot(first, first) > 0) {
        first = normalize(first);
        second = cross(unit, first);
    } else acrossFrame(unit, first, second);
    const Vec3d w = point - centre;
    const double u = exact::atan2(dot(w, second), dot(w, first)) / (2 * kPi);
    return u < 0 ? u + 1 : u;
}

} // namespace alpenglow::geometry

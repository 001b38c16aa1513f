// The map from the square to a spherical triangle is by Arvo, Stratified Sampling of Spherical Triangles (1995); the solid angle
// by Van Oosterom and Strackee, The Solid Angle of a Plane Triangle (1983).
#include "world/trianglelamp.h"
#include "base/exact.h"
#include "geometry/polygon_mesh.h"
#include <algorithm>
#include <cstring>

namespace alpenglow::world {

namespace {
/// A lamp farther than so many of its radii is sampled by area, as the solid angle is then almost uniform over it.
constexpr double kNear = 2.5;
/// Squared distance from a corner, relative to the squared radius; closer, its direction is inaccurate.
constexpr double kLeastDistance2 = 1e-12;
/// Larger solid angles are almost the whole hemisphere of a point on the triangle's plane (2 pi).
constexpr double kMostAngle = 6.2;
/// A near triangle of less is seen edge-on.
constexpr double kLeastAngle = 1e-4;

double solidAngle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    return 2 * exact::atan2(std::fabs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}
double root(double x) { return std::sqrt(std::max(0.0, x)); }

/// Direction to a triangle between unit vectors with this solid angle.
Vec3d direction(const Vec3d& a, const Vec3d& b, const Vec3d& c, double angle, double u, double v) {
    // The part of the triangle next to side ab has fraction u of the solid angle: c moves to `c1` along side ac.
    const Vec3d ab = cross(a, b), ac = cross(a, c);
    const double lengths = length(ab) * length(ac), cosA = dot(ab, ac) / lengths, sinA = std::fabs(dot(a, cross(b, c))) / lengths;
    const auto [sinS, cosS] = exact::sinCos(u * angle);
    const double s = sinS * cosA - cosS * sinA, t = cosS * cosA + sinS * sinA; // of the angle minus that at a
    const double p = t - cosA, q = s + sinA * dot(a, b), divisor = (q * s + p * t) * sinA;
    const double cosB1 = divisor != 0 ? std::clamp(((q * t - p * s) * cosA - q) / divisor, -1.0, 1.0) : 1;
    const Vec3d c1 = a * cosB1 + normalize(c - a * dot(c, a)) * root(1 - cosB1 * cosB1);
    // Then along the arc from b to that point.
    const double z = 1 - v * (1 - dot(c1, b));
    const Vec3d across = c1 - b * dot(c1, b);
    return dot(across, across) > 0 ? b * z + normalize(across) * root(1 - z * z) : b;
}
} // namespace

bool TriangleLamp::has(const geometry::Shape& s) {
    return !s.placed() && !s.exact() && !s.trimmed() && s.mesh().triangles() <= kMost;
}

TriangleLamp::TriangleLamp(const geometry::Shape& s) {
    const geometry::TriMesh& m = s.mesh();
    const geometry::Bounds box = s.bounds();
    centre_ = (Vec3d(box.lo) + Vec3d(box.hi)) * .5;
    for (uint32_t t = 0; t < m.triangles(); ++t) {
        std::array<Vec3d, 3> c;
        for (size_t i = 0; i < 3; ++i) {
            c[i] = Vec3d(m.P[m.index[3 * size_t(t) + i]]);
            radius2_ = std::max(radius2_, dot(c[i] - centre_, c[i] - centre_));
        }
        triangles_.push_back(c);
    }
}

bool TriangleLamp::see(const Vec3& from, Seen& seen) const {
    const Vec3d at(from), way = centre_ - at;
    if (!(dot(way, way) < kNear * kNear * radius2_)) return false;
    seen.total = 0;
    for (size_t t = 0; t < triangles_.size(); ++t) {
        Vec3d c[3];
        for (size_t i = 0; i < 3; ++i) {
            c[i] = triangles_[t][i] - at;
            const double l2 = dot(c[i], c[i]);
            if (!(l2 > kLeastDistance2 * radius2_)) return false;
            c[i] = c[i] / std::sqrt(l2);
        }
        seen.angle[t] = solidAngle(c[0], c[1], c[2]);
        if (!(seen.angle[t] < kMostAngle)) return false;
        seen.total += seen.angle[t];
    }
    return seen.total > kLeastAngle;
}

geometry::HitRef TriangleLamp::place(const Vec3& from, const Seen& seen, Vec2 u) const {
    double left = double(u.x) * seen.total;
    size_t t = 0;
    while (t + 1 < triangles_.size() && left >= seen.angle[t]) left -= seen.angle[t++];
    while (t > 0 && !(seen.angle[t] > 0)) --t;
    const Vec3d at(from), a = triangles_[t][0] - at, b = triangles_[t][1] - at, c = triangles_[t][2] - at;
    const double part = std::clamp(left / seen.angle[t], 0.0, 1.0);
    const Vec3d w = direction(normalize(a), normalize(b), normalize(c), seen.angle[t], part, double(u.y));
    const Vec3d e1 = b - a, e2 = c - a, q = cross(a, w);
    const double facing = dot(cross(e1, e2), w);
    double b1 = 1 / 3., b2 = 1 / 3.;
    if (facing != 0) b1 = std::clamp(dot(q, e2) / facing, 0.0, 1.0), b2 = std::clamp(-dot(q, e1) / facing, 0.0, 1.0 - b1);
    return {uint32_t(t), b1, b2, nullptr, 0};
}

bool TriangleLamp::meet(const Vec3& from, const Vec3& w, geometry::HitRef& hit) const {
    const Vec3d at(from), way(w);
    for (size_t t = 0; t < triangles_.size(); ++t) {
        const Vec3d a = triangles_[t][0] - at, e1 = triangles_[t][1] - triangles_[t][0], e2 = triangles_[t][2] - triangles_[t][0];
        const Vec3d n = cross(e1, e2), q = cross(a, way);
        const double facing = dot(n, way);
        if (!(facing != 0) || !(dot(a, n) / facing > 0)) continue;
        const double b1 = dot(q, e2) / facing, b2 = -dot(q, e1) / facing;
        if (!(b1 >= 0 && b2 >= 0 && b1 + b2 <= 1)) continue;
        hit = {uint32_t(t), b1, b2, nullptr, 0};
        return true;
    }
    return false;
}

bool TriangleLamp::planar() const {
    constexpr double kFlat = 1e-6; // relative to the radius
    Vec3d n(0.);
    for (const auto& t : triangles_)
        if (const Vec3d m = cross(t[1] - t[0], t[2] - t[0]); dot(m, m) > dot(n, n)) n = m;
    const double l = length(n), most = kFlat * std::sqrt(radius2_);
    if (!(l > 0)) return false;
    for (const auto& t : triangles_)
        for (const Vec3d& c : t)
            if (!(std::fabs(dot(c - triangles_[0][0], n)) <= most * l)) return false;
    return true;
}

bool TriangleLamp::flat(const geometry::Shape& s) {
    const auto* polygons = dynamic_cast<const geometry::PolygonMesh*>(&s);
    return polygons && polygons->plain() && !s.diced() && has(s) && s.mesh().triangles() > 0;
}

/// Index of a corner: triangles share corners.
static int cornerIn(FlatEmitter& e, const Vec3d& c) {
    int k = 0;
    while (k < e.cornerCount && std::memcmp(e.corner[k], &c, sizeof c) != 0) ++k;
    if (k == e.cornerCount) std::memcpy(e.corner[e.cornerCount++], &c, sizeof c);
    return k;
}

FlatEmitter TriangleLamp::inBlocks(const geometry::Shape& s) const {
    static_assert(FlatEmitter::kMost >= kMost);
    FlatEmitter e{};
    double area = 0;
    e.count = int(triangles_.size());
    for (size_t t = 0; t < triangles_.size(); ++t) {
        const auto& c = triangles_[t];
        const geometry::SurfacePoint p = s.evaluateHit(uint32_t(t), 1 / 3., 1 / 3.);
        for (size_t i = 0; i < 3; ++i) e.corners[t][i] = cornerIn(e, c[i]);
        for (int q = 0; q < 3; ++q) {
            e.normal[t][q] = p.n[q];
            e.centre[q] = centre_[q];
        }
        e.cumulative[t] = area += 0.5 * length(cross(c[1] - c[0], c[2] - c[0]));
        e.perArea = s.sampleDensity(p);
    }
    e.near2 = kNear * kNear * radius2_;
    e.least2 = kLeastDistance2 * radius2_;
    e.mostAngle = kMostAngle;
    e.leastAngle = kLeastAngle;
    e.oneSided = s.oneSided();
    return e;
}

} // namespace alpenglow::world

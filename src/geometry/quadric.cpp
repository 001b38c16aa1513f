#include "geometry/quadric.h"
#include "base/exact.h"
#include "geometry/edge_curve.h"
#include "geometry/solve.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

using scene::Class;

namespace {
// Limits are widened by this fraction of the range: primitives with a common edge have decimal numbers rounded to float, and rays
// must not slip between them.
constexpr double kEdge = 1e-7;

// transformVector() and transformPoint() of base/, here so that they need no call.
Vec3d turned(const Matrix& a, const Vec3d& v) {
    const auto& m = a.m;
    return {v.x * m[0][0] + v.y * m[1][0] + v.z * m[2][0], v.x * m[0][1] + v.y * m[1][1] + v.z * m[2][1],
            v.x * m[0][2] + v.y * m[1][2] + v.z * m[2][2]};
}
} // namespace

double quadricNumber(const scene::Primitive& p, size_t i, bool& ok) {
    if (i < p.numbers.size() && std::isfinite(p.numbers[i])) return p.numbers[i];
    ok = false;
    return 0;
}

void reportDegenerate(const scene::Primitive& p, Diagnostics& diag, const std::string& why) {
    diag.report(Severity::Warning, Rie::Range, p.place, p.kind + " " + why + "; it is not drawn");
}

Quadric::Quadric(ShapeSource s, double degrees, Diagnostics& diag) : Parametric(std::move(s)) {
    if (std::fabs(degrees) > 360) {
        diag.report(Severity::Warning, Rie::Range, place(), kind() + " sweeps more than 360 degrees; 360 are drawn");
        degrees = std::copysign(360.0, degrees);
    }
    thetaMax_ = degrees * kPi / 180;
    fullTurn_ = std::fabs(degrees) >= 360 - 1e-4;
    toObject_ = inverse(toCamera());
    mirrored_ = determinant3(toCamera()) < 0;
    const auto& m = toObject_.m;
    affine_ = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

void Quadric::finish(Diagnostics& diag) {
    constexpr int kProfileSteps = 64;
    zLo_ = INFINITY;
    zHi_ = -INFINITY;
    for (int i = 0; i <= kProfileSteps; ++i) {
        Profile p = profile(double(i) / kProfileSteps);
        radius_ = std::max(radius_, exact::hypot(p.p.x, p.p.y));
        zLo_ = std::min(zLo_, p.p.z);
        zHi_ = std::max(zHi_, p.p.z);
        if (p.p.y != 0) offAxis_ = true;
    }
    // Between samples a curve strays by at most step^2 / 8 times its second derivative; circles are the worst: 0.5 %.
    double pad = 0.01 * (radius_ + zHi_ - zLo_);
    radius_ += pad;
    zLo_ -= pad;
    zHi_ += pad;
    const auto& m = toCamera().m;
    for (int k = 0; k < 3; ++k)
        pointScale_ =
            std::max(pointScale_, radius_ * (std::fabs(m[0][k]) + std::fabs(m[1][k])) +
                                      std::max(std::fabs(zLo_), std::fabs(zHi_)) * std::fabs(m[2][k]) + std::fabs(m[3][k]));
    whole_ = fullTurn_ && wholeProfile();
    takePrimvars(diag);
}

Bounds Quadric::bounds() const {
    if (!exact()) return Shape::bounds();
    Bounds b;
    for (int i = 0; i < 8; ++i) {
        Vec3d c = transformPoint(toCamera(), Vec3d(i & 1 ? radius_ : -radius_, i & 2 ? radius_ : -radius_, i & 4 ? zHi_ : zLo_));
        b.add(Vec3(c));
    }
    return b;
}

Vec3d Quadric::cameraPosition(double u, double v) const {
    Vec3d p = profile(v).p;
    const auto [s, c] = exact::sinCos(u * thetaMax_);
    return transformPoint(toCamera(), Vec3d(p.x * c - p.y * s, p.x * s + p.y * c, p.z));
}

/// Circles, and the straight lines of some.
bool Quadric::edgeCurve(int side, int, double, double, EdgeCurve& out) const {
    const auto& m = toCamera().m;
    if (std::fabs(m[0][3]) + std::fabs(m[1][3]) + std::fabs(m[2][3]) + std::fabs(m[3][3] - 1) > 1e-7)
        return false; // a perspective
    if (side & 1) {
        const Profile p = profile(0.5);
        if (p.dd.x != 0 || p.dd.y != 0 || p.dd.z != 0) return false;
        const double u = side == 1 ? 1 : 0;
        out = EdgeCurve::line(cameraPosition(u, 0), cameraPosition(u, 1));
        return true;
    }
    Vec3d p = profile(side == 0 ? 0 : 1).p;
    if (std::fabs(p.x) + std::fabs(p.y) < 1e-12 * radius_) p.x = p.y = 0; // the cosine of a quarter turn
    out = EdgeCurve::arc(transformPoint(toCamera(), Vec3d(0, 0, p.z)), transformVector(toCamera(), Vec3d(p.x, p.y, 0)),
                         transformVector(toCamera(), Vec3d(-p.y, p.x, 0)), thetaMax_);
    return true;
}

LocalPoint Quadric::cameraPoint(double u, double v) const {
    Profile q = profile(v);
    const double k = thetaMax_;
    const auto [s, c] = exact::sinCos(u * k);
    auto turn = [&](const Vec3d& p) { return Vec3d(p.x * c - p.y * s, p.x * s + p.y * c, p.z); };
    auto quarter = [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); };
    const Matrix& m = toCamera();
    Vec3d P = turn(q.p), d = turn(q.d), dd = turn(q.dd);
    LocalPoint r;
    r.P = transformPoint(m, P);
    r.Pu = turned(m, quarter(P) * k);
    r.Pv = turned(m, d);
    r.Puu = turned(m, Vec3d(-P.x, -P.y, 0) * (k * k));
    r.Puv = turned(m, quarter(d) * k);
    r.Pvv = turned(m, dd);
    // Direction of Pu x Pv without the factor that vanishes on the axis, and its derivative by v.
    double a = q.p.x, b = q.p.y, da = q.d.x, db = q.d.y, dz = q.d.z;
    Vec3d w, wv;
    if (!offAxis_ || (a == 0 && b == 0)) {
        double sign = a < 0 ? -1 : 1;
        w = Vec3d(dz, 0, -da) * sign;
        wv = Vec3d(q.dd.z, 0, -q.dd.x) * sign;
        if (offAxis_) w = Vec3d(da * dz, db * dz, -(da * da + db * db)), wv = Vec3d(0.0);
    } else {
        w = Vec3d(a * dz, b * dz, -(a * da + b * db));
        wv = Vec3d(da * dz + a * q.dd.z, db * dz + b * q.dd.z, -(da * da + a * q.dd.x + db * db + b * q.dd.y));
    }
    if (k < 0) w = -w, wv = -wv;
    Vec3d n0 = turn(w), n0v = turn(wv), n0u = quarter(n0) * k;
    // Normals go by the inverse transpose; Pu x Pv in camera space is det times that.
    const double det = mirrored_ ? -1 : 1;
    auto normalOut = [&](const Vec3d& n) {
        const auto& i = toObject_.m;
        return Vec3d(i[0][0] * n.x + i[0][1] * n.y + i[0][2] * n.z, i[1][0] * n.x + i[1][1] * n.y + i[1][2] * n.z,
                     i[2][0] * n.x + i[2][1] * n.y + i[2][2] * n.z) *
               det;
    };
    Vec3d nc = normalOut(n0), ncu = normalOut(n0u), ncv = normalOut(n0v);
    double l = length(nc);
    if (!(l > 0)) {
        r.n = normalize(normalOut(Vec3d(0, 0, 1)));
        return r;
    }
    r.n = nc / l;
    r.nu = (ncu - r.n * dot(r.n, ncu)) / l;
    r.nv = (ncv - r.n * dot(r.n, ncv)) / l;
    return r;
}

int Quadric::roots(const Vec3d& o, const Vec3d& d, double t[4]) const {
    Implicit f = implicit();
    if (f.plane) {
        if (d.z == 0) return 0;
        t[0] = (f.height - o.z) / d.z;
        return std::isfinite(t[0]) ? 1 : 0;
    }
    double a = d.x * d.x + d.y * d.y + f.zz * d.z * d.z;
    double h = o.x * d.x + o.y * d.y + f.zz * o.z * d.z + 0.5 * f.z1 * d.z;
    double c = o.x * o.x + o.y * o.y + f.zz * o.z * o.z + f.z1 * o.z + f.c;
    return solveQuadratic(a, h, c, t);
}

bool Quadric::accept(const Vec3d& p, double v, ExactHit& hit) const {
    if (!(v >= -kEdge && v <= 1 + kEdge)) return false;
    hit.v = std::clamp(v, 0.0, 1.0);
    int side = profileSide();
    Vec3d q = side ? Vec3d(side, 0, 0) : profile(hit.v).p;
    double theta = 0;
    if ((q.x != 0 || q.y != 0) && (p.x != 0 || p.y != 0))
        theta = exact::atan2(q.x * p.y - q.y * p.x, q.x * p.x + q.y * p.y); // from the profile to the point
    double turn = thetaMax_ < 0 ? -2 * kPi : 2 * kPi;
    double u = theta / thetaMax_;
    if (u < -kEdge) u = (theta + turn) / thetaMax_;
    if (!(u <= 1 + kEdge)) return false;
    hit.u = std::clamp(u, 0.0, 1.0);
    return true;
}

int Quadric::exactHits(uint32_t, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted, ExactHit out[4]) const {
    Vec3d o = affine_ ? turned(toObject_, org) + Vec3d(toObject_.m[3][0], toObject_.m[3][1], toObject_.m[3][2])
                      : transformPoint(toObject_, org);
    Vec3d d = turned(toObject_, dir);
    double dd = dot(d, d);
    if (!(dd > 0) || !std::isfinite(dd)) return 0;
    // From the point nearest to the centre of the surface: squares of a far origin would swallow the radius.
    Vec3d mid(0, 0, 0.5 * (zLo_ + zHi_));
    double shift = dot(mid - o, d) / dd;
    Vec3d near = o + d * shift;
    double t[4];
    int n = roots(near, d, t), m = 0;
    for (int i = 0; i < n; ++i) {
        Vec3d p = near + d * t[i];
        ExactHit h;
        h.t = shift + t[i];
        if (!std::isfinite(h.t) || !(h.t > lo && h.t <= hi)) continue;
        if (whole_ && wanted == Wanted::Any) {
            out[0] = {h.t, 0, 0};
            return 1;
        }
        bool ok = accept(p, vOf(p), h);
        if (!ok)
            if (auto v2 = secondV(p)) ok = accept(p, *v2, h);
        if (ok && m < 4) out[m++] = h;
        if (ok && wanted != Wanted::All) break;
    }
    return m;
}

std::optional<QuadricForm> Quadric::form() const {
    if (!affine_) return {};
    QuadricForm f{};
    for (int i = 0; i < 4; ++i) std::copy_n(toObject_.m[i], 3, f.toObject[i]);
    f.middle = 0.5 * (zLo_ + zHi_);
    const Implicit i = implicit();
    f.kind = i.plane ? QuadricForm::Kind::Plane : QuadricForm::Kind::Quadratic;
    f.height = i.height, f.zz = i.zz, f.z1 = i.z1, f.c = i.c;
    return f;
}

std::optional<QuadricForm> quadricForm(const Shape& s) {
    const Quadric* q = s.exact() ? dynamic_cast<const Quadric*>(&s) : nullptr;
    return q ? q->form() : std::nullopt;
}

size_t Quadric::classCount(Class c) const { return c == Class::Constant || c == Class::Uniform ? 1 : 4; }

int Quadric::weights(Class c, const SurfacePoint& p, Weight w[16]) const {
    if (c == Class::Constant || c == Class::Uniform) {
        w[0] = {0, 1, 0, 0};
        return 1;
    }
    return bilinearWeights(p.b1, p.b2, 2, 2, false, false, w);
}

} // namespace alpenglow::geometry

// Points: disks that face the ray or the eye, or are perpendicular to "N"; by "type" spheres and squares as well (RISpec 3.2,
// 5.5, PRMan's names).
#include "base/exact.h"
#include "geometry/curves.h"
#include "geometry/dice.h"
#include "geometry/factories.h"
#include "geometry/keyed.h"
#include "geometry/parametric.h"
#include "geometry/solve.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

using scene::Class;

/// The direction toward a ray is encoded in ExactHit: u is 2 * x + (u of the point), v is 2 * y + (v of the point), with x and y
/// in steps of the unfolded octahedron.
constexpr double kSteps = 1 << 24;

double signOf(double x) { return x < 0 ? -1 : 1; }

void packDirection(const Vec3d& d, double& x, double& y) {
    const double l = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    double a = d.x / l, b = d.y / l;
    if (d.z < 0) {
        const double p = (1 - std::fabs(b)) * signOf(a);
        b = (1 - std::fabs(a)) * signOf(b);
        a = p;
    }
    const auto step = [](double s) { return std::clamp(std::floor((0.5 + 0.5 * s) * kSteps), 0.0, kSteps - 1); };
    x = step(a);
    y = step(b);
}
Vec3d unpackDirection(double x, double y) {
    double a = 2 * (x + 0.5) / kSteps - 1, b = 2 * (y + 0.5) / kSteps - 1;
    const double z = 1 - std::fabs(a) - std::fabs(b);
    if (z < 0) {
        const double p = (1 - std::fabs(b)) * signOf(a);
        b = (1 - std::fabs(a)) * signOf(b);
        a = p;
    }
    return normalize(Vec3d(a, b, z));
}

/// To a point within its radius a disc fills nearly all of half of the directions.
constexpr double kWithin = 0.9999;

enum class PointKind { Disc, Ball, Square };

class Points final : public KeyedShape {
public:
    Points(ShapeSource s, PointKind kind) : KeyedShape(std::move(s)), kind_(kind) {}
    bool take(Diagnostics&);

    uint32_t exactPrims() const override { return kept_.empty() ? count_ : uint32_t(kept_.size()); }
    int exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted, float time,
                    ExactHit out[4]) const override;
    /// face: the point.
    SurfacePoint evaluate(int face, double u, double v) const override {
        return pointFrom(uint32_t(std::clamp(face, 0, int(exactPrims()) - 1)), u, v, Vec3d(0.0), 0);
    }
    double area() const override {
        return areas().back() * spread_ * (kind_ == PointKind::Disc ? kPi : kind_ == PointKind::Ball ? 4 * kPi : 4 * aspect_);
    }
    SurfacePoint sampleFromAt(const Vec3& from, double xi1, double xi2, float time) const override;
    double sampleDensity(const SurfacePoint&) const override;
    double turnedDensity(const SurfacePoint&, const Vec3& from) const override;
    bool facesRays() const override { return kind_ != PointKind::Ball && !normal_ && source_.facing == Facing::Ray; }
    Vec3 velocity(const SurfacePoint&) const override;
    void dice(const DiceOptions&, Diagnostics&) override;

protected:
    size_t classCount(Class c) const override { return c == Class::Constant || c == Class::Uniform ? 1 : count_; }
    int weights(Class c, const SurfacePoint& p, Weight w[16]) const override {
        w[0] = {c == Class::Constant || c == Class::Uniform ? 0 : numberOf(p.prim), 1, 0, 0};
        return 1;
    }
    SurfacePoint pointAt(uint32_t prim, double b1, double b2, float time) const override;
    Bounds keyBounds(uint32_t prim) const override;
    bool fits(KeyedShape& later) const override {
        const auto& p = static_cast<const Points&>(later);
        return kind_ == p.kind_ && count_ == p.count_ && kept_ == p.kept_ && !normal_ == !p.normal_;
    }

private:
    /// A point at a time.
    struct Now {
        Vec3d centre, normal; ///< the variable "N" if given
        double radius;
    };
    Now nowAt(uint32_t prim, float time) const {
        double way;
        const size_t k = keyAt(time, way);
        return nowAt(prim, k, way);
    }
    Now nowAt(uint32_t prim, size_t key, double way) const;
    uint32_t numberOf(uint32_t prim) const { return kept_.empty() ? prim : kept_[prim]; }
    Vec3d centre(uint32_t prim) const {
        const float* p = P_ + 3 * size_t(numberOf(prim));
        return {p[0], p[1], p[2]};
    }
    double radius(uint32_t prim) const { return 0.5 * std::max(0.f, width_[widthStep_ * numberOf(prim)]); }
    double meanSquare(uint32_t prim) const; ///< of the radii at the keys
    Vec3d facing(const Now&, const Vec3d& against) const;
    LocalPoint place(const Now&, const Vec3d& n, double u, double v) const;
    void sides(const Vec3d& n, Vec3d& a, Vec3d& b) const;
    SurfacePoint pointFrom(uint32_t prim, double u, double v, const Vec3d& from, float time) const;
    SurfacePoint discFrom(uint32_t prim, double radius, double angle, const Vec3d& from, float time) const;
    const std::vector<double>& areas() const;

    PointKind kind_;
    uint32_t count_ = 0;
    std::vector<uint32_t> kept_; ///< of the request's; empty: all
    const float *P_ = nullptr, *width_ = nullptr, *normal_ = nullptr;
    std::vector<float> divided_;
    size_t widthStep_ = 0, normalStep_ = 0;
    double aspect_ = 1, turnSin_ = 0, turnCos_ = 1; ///< of squares
    Matrix toObject_;
    Vec3d eye_, backward_, up_;
    double side_ = 1, reach_[3], spread_ = 1;
    mutable std::once_flag made_;
    mutable std::vector<double> areas_; ///< cumulative squares of radii; for moving points the mean of the keys
};

bool Points::take(Diagnostics& diag) {
    const scene::Primitive& p = *source_.primitive;
    toObject_ = inverse(toCamera());
    eye_ = transformPoint(toObject_, Vec3d(0.0));
    backward_ = transformVector(toObject_, Vec3d(0, 0, -1));
    up_ = transformVector(toObject_, Vec3d(0, 1, 0));
    const auto& m = toCamera().m;
    for (int k = 0; k < 3; ++k) reach_[k] = std::sqrt(m[0][k] * m[0][k] + m[1][k] * m[1][k] + m[2][k] * m[2][k]);
    const Vec3d r0(m[0][0], m[0][1], m[0][2]), r1(m[1][0], m[1][1], m[1][2]), r2(m[2][0], m[2][1], m[2][2]);
    const double det = dot(cross(r0, r1), r2);
    side_ = (det < 0 ? -1 : 1) * double(orientation_);
    spread_ = exact::pow(std::fabs(det), 2. / 3);
    if (const scene::Param* P = lastParam(p.params, "P")) P_ = P->numbers.data(), count_ = uint32_t(P->numbers.size() / 3);
    else if (const scene::Param* Pw = lastParam(p.params, "Pw")) {
        count_ = uint32_t(Pw->numbers.size() / 4);
        for (size_t i = 0; i < count_; ++i)
            for (size_t k = 0; k < 3; ++k) divided_.push_back(Pw->numbers[4 * i + k] / Pw->numbers[4 * i + 3]);
        P_ = divided_.data();
    }
    if (!count_) {
        diag.report(Severity::Warning, Rie::MissingData, p.place, "Points without points; nothing is drawn");
        return false;
    }
    static constexpr float kOne = 1; // RISpec
    width_ = &kOne;
    const auto values = [&](const char* name, size_t width, const float*& to, size_t& step) {
        const scene::Param* q = lastParam(p.params, name);
        if (!q || q->type == scene::Type::String) return;
        const bool one = q->cls == Class::Constant || q->cls == Class::Uniform;
        if (q->numbers.size() < width * (one ? 1 : count_)) {
            diag.report(Severity::Error, Rie::MissingData, q->place,
                        "Points \"" + q->name + "\": " + std::to_string(q->numbers.size()) + " values given, " +
                            std::to_string(width * count_) + " needed; the variable is ignored");
            return;
        }
        to = q->numbers.data();
        step = one ? 0 : width;
    };
    values("constantwidth", 1, width_, widthStep_);
    values("width", 1, width_, widthStep_);
    if (kind_ == PointKind::Disc) values("N", 3, normal_, normalStep_);
    const float *aspect = nullptr, *angle = nullptr;
    size_t none = 0;
    values("patchaspectratio", 1, aspect, none); // of squares alike: the first value
    values("patchangle", 1, angle, none);
    if (aspect && *aspect > 0 && std::isfinite(*aspect)) aspect_ = 1 / double(*aspect);
    if (angle && std::isfinite(*angle)) {
        const auto turn = exact::sinCos(double(*angle) * kPi / 180);
        turnSin_ = turn.sin, turnCos_ = turn.cos;
    }
    size_t notFinite = 0, thin = 0;
    std::vector<uint32_t> kept;
    const bool key = isKey(source_); // a width may grow from 0
    source_.like = nullptr;
    for (uint32_t i = 0; i < count_; ++i) {
        const float *q = P_ + 3 * size_t(i), w = width_[widthStep_ * i], *n = normal_ ? normal_ + normalStep_ * i : q;
        if (!std::isfinite(q[0]) || !std::isfinite(q[1]) || !std::isfinite(q[2]) || !std::isfinite(w) ||
            !std::isfinite(n[0] + n[1] + n[2]))
            ++notFinite;
        else if (!key && !(w > 0)) ++thin;
        else kept.push_back(i);
    }
    if (notFinite)
        diag.report(Severity::Error, Rie::Range, p.place,
                    "Points: " + std::to_string(notFinite) + " with a number that is not finite; not drawn");
    if (thin)
        diag.report(Severity::Warning, Rie::Range, p.place, "Points: " + std::to_string(thin) + " without a width; not drawn");
    if (kept.empty()) return false;
    if (kept.size() < count_) kept_ = std::move(kept);
    measure();
    takePrimvars(diag);
    return true;
}

Bounds Points::keyBounds(uint32_t prim) const {
    const Vec3d c = transformPoint(toCamera(), centre(prim));
    const double r = radius(prim) * (kind_ == PointKind::Square ? std::sqrt(1 + aspect_ * aspect_) : 1) * 1.000001;
    const double slack = 1e-6 * (std::fabs(c.x) + std::fabs(c.y) + std::fabs(c.z)) + 1e-30;
    const Vec3d to(reach_[0] * r + slack, reach_[1] * r + slack, reach_[2] * r + slack);
    Bounds b;
    b.add(Vec3(c - to));
    b.add(Vec3(c + to));
    return b;
}

/// Centres, radii and normals are linear between keys.
Points::Now Points::nowAt(uint32_t prim, size_t k, double way) const {
    const auto of = [&](size_t i) {
        const Points& p = static_cast<const Points&>(key(i));
        const float* n = p.normal_ ? p.normal_ + p.normalStep_ * numberOf(prim) : nullptr;
        return Now{p.centre(prim), n ? Vec3d(n[0], n[1], n[2]) : Vec3d(0.0), p.radius(prim)};
    };
    const Now a = of(k);
    if (way == 0 || k + 1 >= keys()) return a;
    const Now b = of(k + 1);
    return {a.centre * (1 - way) + b.centre * way, a.normal * (1 - way) + b.normal * way, a.radius * (1 - way) + b.radius * way};
}

/// The direction that a disk faces, not unit; `against`: the origin of a ray.
Vec3d Points::facing(const Now& now, const Vec3d& against) const {
    if (normal_) return now.normal * (side_ * orientation_ < 0 ? -1.0 : 1.0);
    return source_.facing == Facing::Ray ? against : source_.facing == Facing::Eye ? eye_ - now.centre : backward_;
}

/// Unit vectors along u and v: a ^ b is along n (handedness: side_).
void Points::sides(const Vec3d& n, Vec3d& a, Vec3d& b) const {
    acrossFrame(n, a, b);
    if (kind_ == PointKind::Square) { // v upward in the picture
        const Vec3d right = cross(up_, n);
        if (dot(right, right) > 1e-20 * dot(up_, up_) * dot(n, n)) a = normalize(right), b = normalize(cross(n, a));
        const Vec3d x = a * turnCos_ + b * turnSin_;
        b = b * turnCos_ - a * turnSin_;
        a = x;
    }
    if (side_ < 0) a = -a;
}

int Points::exactHitsAt(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted, float time,
                        ExactHit out[4]) const {
    const Now now = nowAt(prim, time);
    const Vec3d o = transformPoint(toObject_, org), d = transformVector(toObject_, dir), c = now.centre;
    const double r = now.radius;
    if (!(r > 0)) return 0;
    const double dd = dot(d, d), shift = dot(c - o, d) / dd;
    const Vec3d near = o + d * shift - c; // from the point nearest the centre
    if (kind_ == PointKind::Ball) {
        double t[2];
        const int roots = solveQuadratic(dd, dot(near, d), dot(near, near) - r * r, t);
        int n = 0;
        for (int i = 0; i < roots; ++i) {
            const double at = shift + t[i];
            if (!(at > lo && at <= hi)) continue;
            const Vec3d w = near + d * t[i];
            const double u = exact::atan2(w.y, w.x) / (2 * kPi), v = exact::asin(std::clamp(w.z / r, -1.0, 1.0)) / kPi + 0.5;
            out[n++] = {at, u < 0 ? u + 1 : u, v};
            if (wanted != Wanted::All) break;
        }
        return n;
    }
    Vec3d n = facing(now, -d);
    const double along = dot(d, n);
    if (along == 0) return 0;
    const double step = -dot(near, n) / along, t = shift + step;
    if (!(t > lo && t <= hi)) return 0;
    const Vec3d w = near + d * step;
    if (kind_ == PointKind::Disc && !(dot(w, w) <= r * r)) return 0;
    double x = 0, y = 0;
    if (facesRays()) {
        packDirection(n, x, y);
        n = unpackDirection(x, y);
    }
    Vec3d a, b;
    sides(n, a, b);
    const double u = dot(w, a) / r, v = dot(w, b) / r;
    if (kind_ == PointKind::Square && !(std::fabs(u) <= 1 && std::fabs(v) <= aspect_)) return 0;
    out[0] = {t, 2 * x + std::clamp(0.5 + 0.5 * u, 0.0, 1.0), 2 * y + std::clamp(0.5 + 0.5 * v / aspect_, 0.0, 1.0)};
    return 1;
}

/// Object space; n: the direction that a disk faces.
LocalPoint Points::place(const Now& now, const Vec3d& n, double u, double v) const {
    const double r = now.radius;
    LocalPoint o;
    if (kind_ == PointKind::Ball) {
        const auto [su, cu] = exact::sinCos(2 * kPi * u);
        const auto [sv, cv] = exact::sinCos(kPi * (v - 0.5));
        const Vec3d out(cu * cv, su * cv, sv);
        o.P = now.centre + out * r;
        o.Pu = Vec3d(-su * cv, cu * cv, 0) * (2 * kPi * r);
        o.Pv = Vec3d(-cu * sv, -su * sv, cv) * (kPi * r);
        o.Puu = Vec3d(-cu * cv, -su * cv, 0) * (4 * kPi * kPi * r);
        o.Puv = Vec3d(su * sv, -cu * sv, 0) * (2 * kPi * kPi * r);
        o.Pvv = out * (-kPi * kPi * r);
        o.n = out * side_;
    } else {
        Vec3d a, b;
        sides(n, a, b);
        o.Pu = a * (2 * r);
        o.Pv = b * (2 * r * aspect_);
        o.P = now.centre + o.Pu * (u - 0.5) + o.Pv * (v - 0.5);
        o.n = n;
    }
    return o;
}

SurfacePoint Points::pointAt(uint32_t prim, double b1, double b2, float time) const {
    const Now now = nowAt(prim, time);
    const double x = facesRays() ? std::floor(0.5 * b1) : 0, y = facesRays() ? std::floor(0.5 * b2) : 0, u = b1 - 2 * x,
                 v = b2 - 2 * y;
    const double side = orientation_;
    const LocalPoint o = place(now, facesRays() ? unpackDirection(x, y) : facing(now, backward_), u, v);
    const Matrix& m = toCamera();
    LocalPoint q{transformPoint(m, o.P),
                 transformVector(m, o.Pu),
                 transformVector(m, o.Pv),
                 transformVector(m, o.Puu),
                 transformVector(m, o.Puv),
                 transformVector(m, o.Pvv),
                 {},
                 {},
                 {}};
    const Vec3d across = cross(q.Pu, q.Pv) * side;
    const double l = length(across);
    // At a ball's poles the product is rounding only.
    q.n = l > 1e-6 * dot(q.Pv, q.Pv) ? across / l : normalize(transformNormal(m, o.n));
    normalDerivatives(q);
    SurfacePoint p;
    p.P = Vec3(q.P);
    p.dPdu = Vec3(q.Pu), p.dPdv = Vec3(q.Pv);
    p.Puu = Vec3(q.Puu), p.Puv = Vec3(q.Puv), p.Pvv = Vec3(q.Pvv);
    p.n = Vec3(q.n);
    p.dNdu = Vec3(q.nu), p.dNdv = Vec3(q.nv);
    p.Ng = l > 0 ? Vec3(across) : p.n;
    if (kind_ == PointKind::Square) p.u = float(u), p.v = float(v); // of others they are 0 (RISpec 3.2, 5.5)
    p.orientation = orientation_;
    p.prim = prim;
    p.b1 = u;
    p.b2 = v;
    p.time = time;
    // A ray that leaves a disk facing the previous ray must not hit the disk in its new orientation.
    p.pError = 2 * roundingError(p.P) + (facesRays() ? 0.26f * std::max(length(p.dPdu), length(p.dPdv)) : 0);
    finishPoint(p, true);
    if (kind_ != PointKind::Square) p.dsdu = p.dsdv = p.dtdu = p.dtdv = 0;
    if (kind_ == PointKind::Ball) p.N = p.n;
    return p;
}

SurfacePoint Points::pointFrom(uint32_t prim, double u, double v, const Vec3d& from, float time) const {
    double x = 0, y = 0;
    if (facesRays()) {
        const Now now = nowAt(prim, time);
        const Vec3d eye = transformPoint(toObject_, from);
        Vec3d to = eye - now.centre;
        for (int k = 0; k < kTurnsToRay; ++k) to = eye - place(now, to, u, v).P;
        packDirection(to, x, y);
    }
    return pointAt(prim, 2 * x + u, 2 * y + v, time);
}

/// For a disk that faces rays: the hit of a ray from `from` that passes its centre at this fraction of its radius. All such
/// points are on the sphere whose diameter is the segment to the centre (Thales).
SurfacePoint Points::discFrom(uint32_t prim, double part, double angle, const Vec3d& from, float time) const {
    const Now now = nowAt(prim, time);
    const Vec3d eye = transformPoint(toObject_, from), to = now.centre - eye;
    const double far = length(to);
    if (!(far > 0) || !(now.radius > 0)) return pointFrom(prim, 0.5, 0.5, from, time);
    const double sine = part * std::min(now.radius / far, kWithin), cosine = std::sqrt(1 - sine * sine);
    Vec3d a, b;
    acrossFrame(to, a, b);
    const auto [s, c] = exact::sinCos(angle);
    const Vec3d w = to / far * cosine + (a * c + b * s) * sine;
    double x, y;
    packDirection(-w, x, y);
    sides(unpackDirection(x, y), a, b);
    const Vec3d off = eye + w * (far * cosine) - now.centre;
    const auto place = [&](const Vec3d& side) { return std::clamp(0.5 + 0.5 * dot(off, side) / now.radius, 0.0, 1.0); };
    return pointAt(prim, 2 * x + place(a), 2 * y + place(b), time);
}

double Points::turnedDensity(const SurfacePoint& p, const Vec3& from) const {
    if (!facesRays() || kind_ == PointKind::Ball) return 1;
    const Now now = nowAt(p.prim, p.time);
    const Vec3d eye = transformPoint(toObject_, Vec3d(from)), P = transformPoint(toObject_, Vec3d(p.P));
    const double far = length(now.centre - eye), way = length(P - eye);
    if (!(way > 0)) return 0;
    const double least = kind_ == PointKind::Disc ? std::min(1.0, kWithin * far / now.radius) : 1; // of the radius, within it
    return far / (way * least * least);
}

/// For a disk that faces rays, the velocity of its centre, as the orientation depends on the viewer.
Vec3 Points::velocity(const SurfacePoint& at) const {
    double way;
    const size_t k = keyAt(at.time, way);
    if (k + 1 >= keys()) return Vec3(0.f);
    return slopeOf(k, way, [&](double w) {
        const Now now = nowAt(at.prim, k, w);
        if (facesRays()) return transformPoint(toCamera(), now.centre);
        return transformPoint(toCamera(), place(now, facing(now, backward_), at.b1, at.b2).P);
    });
}

double Points::meanSquare(uint32_t prim) const {
    double sum = 0;
    for (size_t k = 0; k < keys(); ++k) {
        const double r = static_cast<const Points&>(key(k)).radius(prim);
        sum += r * r;
    }
    return sum / double(keys());
}

const std::vector<double>& Points::areas() const {
    std::call_once(made_, [&] {
        double sum = 0;
        areas_.reserve(exactPrims());
        for (uint32_t i = 0; i < exactPrims(); ++i) areas_.push_back(sum += meanSquare(i));
    });
    return areas_;
}

SurfacePoint Points::sampleFromAt(const Vec3& whence, double xi1, double xi2, float time) const {
    const Vec3d from(whence);
    const std::vector<double>& sums = areas();
    const double target = xi1 * sums.back();
    const size_t i = std::min(size_t(std::upper_bound(sums.begin(), sums.end(), target) - sums.begin()), sums.size() - 1);
    const double lo = i ? sums[i - 1] : 0, x = std::clamp((target - lo) / (sums[i] - lo), 0.0, 1.0);
    if (kind_ == PointKind::Square) return pointFrom(uint32_t(i), x, xi2, from, time);
    if (kind_ == PointKind::Ball)
        return pointFrom(uint32_t(i), xi2, exact::asin(std::clamp(2 * x - 1, -1.0, 1.0)) / kPi + 0.5, from, time);
    if (facesRays()) return discFrom(uint32_t(i), std::sqrt(x), 2 * kPi * xi2, from, time);
    const auto [s, c] = exact::sinCos(2 * kPi * xi2);
    const double r = 0.5 * std::sqrt(x);
    return pointFrom(uint32_t(i), 0.5 + r * c, 0.5 + r * s, from, time);
}

double Points::sampleDensity(const SurfacePoint& p) const {
    const double r = nowAt(p.prim, p.time).radius, share = meanSquare(p.prim) / areas().back(),
                 l = length(cross(Vec3d(p.dPdu), Vec3d(p.dPdv)));
    if (kind_ == PointKind::Ball) { // uniform over the sphere in object space, which the transformation stretches
        const double cosine = exact::cos(kPi * (p.b2 - 0.5));
        return l > 0 ? share * 2 * kPi * kPi * cosine / (4 * kPi * l) : share / (4 * kPi * r * r * spread_);
    }
    return l > 0 ? share / (kind_ == PointKind::Disc ? 0.25 * kPi * l : l) : 0;
}

void Points::dice(const DiceOptions& o, Diagnostics& diag) { reportNotDisplaced(*this, o, diag); }

} // namespace

ShapeRef makePoints(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    PointKind kind = PointKind::Disc;
    if (const scene::Param* type = lastParam(p.params, "type"); type && !type->strings.empty()) {
        const std::string& t = type->strings[0];
        if (t == "sphere") kind = PointKind::Ball;
        else if (t == "patch") kind = PointKind::Square;
        else if (t != "particle" && t != "disk" && t != "disc") {
            if (t == "blobby") kind = PointKind::Ball;
            Diagnostic d;
            d.severity = Severity::Warning;
            d.code = t == "blobby" ? Rie::Incapable : Rie::BadToken;
            d.place = type->place;
            d.message = t == "blobby" ? "Points of type \"blobby\" are drawn as spheres, which do not blend"
                                      : "Points of type \"" + t +
                                            "\" are drawn as particles; known are particle, disk, sphere, patch and blobby";
            diag.reportOnce("geometry:points:" + t, d);
        }
    }
    auto shape = std::make_shared<Points>(std::move(s), kind);
    return shape->take(diag) ? shape : nullptr;
}

} // namespace alpenglow::geometry

// Sphere radius zmin zmax thetamax.
#include "base/exact.h"
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

// Hits on spheres. Their parameters are the direction from the centre as a point of the unfolded octahedron (Meyer et al., "On
// Floating-Point Normal Vectors", EGSR 2010), rather than u and v, whose arctangents few shaders need. kCode distinguishes them.
constexpr double kCode = 3;
bool isCode(double b1) { return b1 > 1.5; }
double signed1(double x) { return x < 0 ? -1 : 1; }
void encode(const Vec3d& d, ExactHit& hit) {
    const double size = std::fabs(d.x) + std::fabs(d.y) + std::fabs(d.z);
    double a = d.x / size, b = d.y / size;
    if (d.z < 0) {
        const double x = a;
        a = (1 - std::fabs(b)) * signed1(x);
        b = (1 - std::fabs(x)) * signed1(b);
    }
    hit.u = kCode + a;
    hit.v = b;
}
Vec3d decode(double b1, double b2) {
    const double a = b1 - kCode;
    Vec3d d(a, b2, 1 - std::fabs(a) - std::fabs(b2));
    if (d.z < 0) d = Vec3d((1 - std::fabs(b2)) * signed1(a), (1 - std::fabs(a)) * signed1(b2), d.z);
    return d / length(d);
}

class Sphere final : public Quadric {
public:
    Sphere(ShapeSource s, double r, double zmin, double zmax, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), r_(r) {
        phi0_ = exact::asin(std::clamp(zmin / r, -1.0, 1.0));
        phi1_ = exact::asin(std::clamp(zmax / r, -1.0, 1.0));
        finish(d);
        setBall();
    }
    using Shape::exactHits;
    int exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted,
                  ExactHit out[4]) const override;
    bool empty() const { return phi0_ == phi1_; }
    std::optional<QuadricForm> form() const override {
        std::optional<QuadricForm> f = Quadric::form();
        if (f && radius_ > 0) f->kind = QuadricForm::Kind::Ball, f->centre = centre_, f->radius = radius_;
        return f;
    }

private:
    Profile profile(double v) const override {
        const double k = phi1_ - phi0_;
        const auto [s, c] = exact::sinCos(phi0_ + v * k);
        return {{r_ * c, 0, r_ * s}, {-r_ * k * s, 0, r_ * k * c}, {-r_ * k * k * c, 0, -r_ * k * k * s}};
    }
    int profileSide() const override { return r_ > 0 ? 1 : -1; } // the cosine of an arcsine
    Implicit implicit() const override { return {false, 0, 1, 0, -r_ * r_}; }
    bool wholeProfile() const override { return std::min(phi0_, phi1_) <= -kPi / 2 && std::max(phi0_, phi1_) >= kPi / 2; }
    double vOf(const Vec3d& p) const override {
        double phi = exact::atan2(r_ < 0 ? -p.z : p.z, std::sqrt(p.x * p.x + p.y * p.y));
        return (phi - phi0_) / (phi1_ - phi0_);
    }
    void setBall();
    using Quadric::evaluateLocal;
    SurfacePoint evaluateLocal(uint32_t prim, double b1, double b2) const override {
        SurfacePoint p;
        evaluateLocal(prim, b1, b2, p, kNeedAll);
        return p;
    }
    void evaluateLocal(uint32_t prim, double b1, double b2, SurfacePoint& out, uint32_t needs) const override;
    Vec3d localNormal(uint32_t prim, double b1, double b2) const override {
        return isCode(b1) ? decode(b1, b2) * outward_ : Quadric::localNormal(prim, b1, b2);
    }
    double r_, phi0_, phi1_;
    /// A complete sphere that is also a sphere in camera space: centre and radius there, and the side of n. 0: other spheres.
    Vec3d centre_, axis_; ///< axis: the sphere's own z, unit
    double radius_ = 0, outward_ = 1;
    double stretch_ = 0; ///< |dPdu ^ dPdv| at the equator
    float slack_ = 0;    ///< how far the surface by u and v may be off the ball
};

void Sphere::setBall() {
    const auto& m = toCamera().m;
    if (!whole() || m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) return;
    const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    // Matrices of exporters are rounded to float, or to some digits: a sphere stays one.
    const double size = exact::pow(std::fabs(determinant3(toCamera())), 2. / 3);
    double most = 0;
    for (const double off : {dot(x, y), dot(y, z), dot(z, x), dot(x, x) - size, dot(y, y) - size, dot(z, z) - size})
        most = std::max(most, std::fabs(off));
    if (!(most <= 1e-6 * size)) return; // an ellipsoid
    centre_ = Vec3d(m[3][0], m[3][1], m[3][2]);
    const LocalPoint p = cameraPoint(.25, .25);
    outward_ = (dot(p.n, p.P - centre_) < 0 ? -1 : 1) * double(orientation_);
    radius_ = std::fabs(r_) * std::sqrt(size);
    if (most > 1e-12 * size) slack_ = float(2 * most / size * radius_);
    axis_ = normalize(z);
    stretch_ = length(cross(p.Pu, p.Pv)) / std::sqrt(1 - std::min(1., dot(p.n, axis_) * dot(p.n, axis_)));
}

int Sphere::exactHits(uint32_t prim, const Vec3d& org, const Vec3d& dir, double lo, double hi, Wanted wanted,
                      ExactHit out[4]) const {
    if (!(radius_ > 0)) return Quadric::exactHits(prim, org, dir, lo, hi, wanted, out);
    const double dd = dot(dir, dir);
    if (!(dd > 0) || !std::isfinite(dd)) return 0;
    // From the point of the line nearest to the centre: squares of a far origin would swallow the radius.
    const Vec3d to = centre_ - org;
    const double shift = dot(to, dir) / dd;
    const Vec3d near = dir * shift - to;
    const double left = radius_ * radius_ - dot(near, near);
    if (!(left >= 0)) return 0;
    const double half = std::sqrt(left / dd);
    int n = 0;
    for (const double way : {-half, half}) {
        const double t = shift + way;
        if (!std::isfinite(t) || !(t > lo && t <= hi) || (n > 0 && half == 0)) continue;
        out[n] = {t, 0, 0};
        if (wanted != Wanted::Any) encode(near + dir * way, out[n]);
        ++n;
        if (wanted != Wanted::All) break;
    }
    return n;
}

void Sphere::evaluateLocal(uint32_t prim, double b1, double b2, SurfacePoint& out, uint32_t needs) const {
    if (!isCode(b1)) {
        out = Quadric::evaluateLocal(prim, b1, b2);
        out.pError += slack_;
        return;
    }
    const Vec3d d = decode(b1, b2);
    if ((needs & ~uint32_t(kNeedN | kNeedNg)) != 0 || !primvars().empty() || normal_.param) {
        const Vec3d p = transformPoint(toObject(), centre_ + d * radius_);
        ExactHit at{};
        accept(p, vOf(p), at);
        out = Quadric::evaluateLocal(prim, at.u, at.v);
    } else {
        static const SurfacePoint kBlank;
        out = kBlank; // unneeded members are the same in every run
        const double height = dot(d, axis_), Ng = stretch_ * std::sqrt(std::max(0., 1 - height * height));
        out.orientation = orientation_;
        out.Ng = Vec3(d * (outward_ * (Ng > 0 ? Ng : 1)));
    }
    out.P = Vec3(centre_ + d * radius_);
    out.n = Vec3(d * outward_);
    if (!normal_.param) out.N = out.n;
    out.pError = roundingError(out.P) + float(4e-15 * pointScale_) + slack_;
}

} // namespace

ShapeRef makeSphere(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double r = quadricNumber(p, 0, ok), zmin = quadricNumber(p, 1, ok), zmax = quadricNumber(p, 2, ok),
           sweep = quadricNumber(p, 3, ok);
    if (!ok) return reportDegenerate(p, diag, "needs four finite numbers"), nullptr;
    if (r == 0 || sweep == 0) return reportDegenerate(p, diag, "has no radius or no sweep"), nullptr;
    auto shape = std::make_shared<Sphere>(std::move(s), r, zmin, zmax, sweep, diag);
    if (shape->empty()) return reportDegenerate(p, diag, "has no height between zmin and zmax"), nullptr;
    return shape;
}

} // namespace alpenglow::geometry

// Sphere radius zmin zmax thetamax.
#include "base/exact.h"
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Sphere final : public Quadric {
public:
    Sphere(ShapeSource s, double r, double zmin, double zmax, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), r_(r) {
        phi0_ = exact::asin(std::clamp(zmin / r, -1.0, 1.0));
        phi1_ = exact::asin(std::clamp(zmax / r, -1.0, 1.0));
        finish(d);
    }
    bool empty() const { return phi0_ == phi1_; }

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
    double r_, phi0_, phi1_;
};

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

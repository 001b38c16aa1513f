// Paraboloid rmax zmin zmax thetamax.
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Paraboloid final : public Quadric {
public:
    Paraboloid(ShapeSource s, double r, double zmin, double zmax, double zref, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), r_(r), zmin_(zmin), zmax_(zmax), zref_(zref) {
        finish(d);
    }

private:
    Profile profile(double v) const override {
        double k = zmax_ - zmin_, z = zmin_ + v * k;
        // At the apex the radius grows like a root: derivatives are taken slightly next to it.
        double x = std::max(z / zref_, 0.0), y = std::max(x, 1e-9), root = std::sqrt(y), dx = k / zref_;
        return {{r_ * std::sqrt(x), 0, z}, {r_ * dx / (2 * root), 0, k}, {-r_ * dx * dx / (4 * root * y), 0, 0}};
    }
    Implicit implicit() const override { return {false, 0, 0, -r_ * r_ / zref_, 0}; }
    double vOf(const Vec3d& p) const override { return (p.z - zmin_) / (zmax_ - zmin_); }
    double r_, zmin_, zmax_, zref_; ///< zref: the height where the radius is rmax
};

} // namespace

ShapeRef makeParaboloid(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double r = quadricNumber(p, 0, ok), zmin = quadricNumber(p, 1, ok), zmax = quadricNumber(p, 2, ok),
           sweep = quadricNumber(p, 3, ok);
    if (!ok) return reportDegenerate(p, diag, "needs four finite numbers"), nullptr;
    double zref = zmax;
    if (zref == 0) zref = zmin; // swapped limits of a bowl on its apex
    if (r == 0 || sweep == 0 || zref == 0 || zmin == zmax)
        return reportDegenerate(p, diag, "has no radius, no sweep or no height"), nullptr;
    if (zmin / zref < 0) {
        diag.report(Severity::Warning, Rie::Range, p.place, "Paraboloid zmin is beyond its apex; it is drawn from the apex");
        zmin = 0;
    }
    return std::make_shared<Paraboloid>(std::move(s), r, zmin, zmax, zref, sweep, diag);
}

} // namespace alpenglow::geometry

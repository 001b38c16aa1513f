// Cylinder radius zmin zmax thetamax.
#include "geometry/factories.h"
#include "geometry/quadric.h"

namespace alpenglow::geometry {
namespace {

class Cylinder final : public Quadric {
public:
    Cylinder(ShapeSource s, double r, double zmin, double zmax, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), r_(r), zmin_(zmin), zmax_(zmax) {
        finish(d);
    }

private:
    Profile profile(double v) const override { return {{r_, 0, zmin_ + v * (zmax_ - zmin_)}, {0, 0, zmax_ - zmin_}, {}}; }
    Implicit implicit() const override { return {false, 0, 0, 0, -r_ * r_}; }
    double vOf(const Vec3d& p) const override { return (p.z - zmin_) / (zmax_ - zmin_); }
    double r_, zmin_, zmax_;
};

} // namespace

ShapeRef makeCylinder(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double r = quadricNumber(p, 0, ok), zmin = quadricNumber(p, 1, ok), zmax = quadricNumber(p, 2, ok),
           sweep = quadricNumber(p, 3, ok);
    if (!ok) return reportDegenerate(p, diag, "needs four finite numbers"), nullptr;
    if (r == 0 || sweep == 0 || zmin == zmax) return reportDegenerate(p, diag, "has no radius, no sweep or no height"), nullptr;
    return std::make_shared<Cylinder>(std::move(s), r, zmin, zmax, sweep, diag);
}

} // namespace alpenglow::geometry

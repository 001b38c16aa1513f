// Disk height radius thetamax.
#include "base/exact.h"
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Disk final : public Quadric {
public:
    Disk(ShapeSource s, double height, double r, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), h_(height), r_(r) {
        finish(d);
    }

private:
    Profile profile(double v) const override { return {{r_ * (1 - v), 0, h_}, {-r_, 0, 0}, {}}; }
    Implicit implicit() const override { return {true, h_}; }
    double vOf(const Vec3d& p) const override { return 1 - exact::hypot(p.x, p.y) / std::fabs(r_); }
    double h_, r_;
};

} // namespace

ShapeRef makeDisk(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double h = quadricNumber(p, 0, ok), r = quadricNumber(p, 1, ok), sweep = quadricNumber(p, 2, ok);
    if (!ok) return reportDegenerate(p, diag, "needs three finite numbers"), nullptr;
    if (r == 0 || sweep == 0) return reportDegenerate(p, diag, "has no radius or no sweep"), nullptr;
    return std::make_shared<Disk>(std::move(s), h, r, sweep, diag);
}

} // namespace alpenglow::geometry

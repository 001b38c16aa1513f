// Cone height radius thetamax.
#include "base/exact.h"
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Cone final : public Quadric {
public:
    Cone(ShapeSource s, double height, double r, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), h_(height), r_(r) {
        finish(d);
    }

private:
    Profile profile(double v) const override { return {{r_ * (1 - v), 0, v * h_}, {-r_, 0, h_}, {}}; }
    Implicit implicit() const override {
        if (h_ == 0) return {true, 0}; // flat: a disk
        double k = r_ * r_ / h_;       // x^2 + y^2 = r^2 (1 - z/h)^2
        return {false, 0, -k / h_, 2 * k, -r_ * r_};
    }
    double vOf(const Vec3d& p) const override { return h_ == 0 ? 1 - exact::hypot(p.x, p.y) / std::fabs(r_) : p.z / h_; }
    double h_, r_;
};

} // namespace

ShapeRef makeCone(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double h = quadricNumber(p, 0, ok), r = quadricNumber(p, 1, ok), sweep = quadricNumber(p, 2, ok);
    if (!ok) return reportDegenerate(p, diag, "needs three finite numbers"), nullptr;
    if (r == 0 || sweep == 0) return reportDegenerate(p, diag, "has no radius or no sweep"), nullptr;
    return std::make_shared<Cone>(std::move(s), h, r, sweep, diag);
}

} // namespace alpenglow::geometry

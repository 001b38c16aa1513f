// Hyperboloid x1 y1 z1 x2 y2 z2 thetamax: the line from p1 to p2 turned about z.
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include "geometry/solve.h"
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Hyperboloid final : public Quadric {
public:
    Hyperboloid(ShapeSource s, const Vec3d& p1, const Vec3d& p2, double sweep, Diagnostics& diag)
        : Quadric(std::move(s), sweep, diag), p_(p1), d_(p2 - p1) {
        finish(diag);
    }

private:
    Profile profile(double v) const override { return {p_ + d_ * v, d_, {}}; }
    Implicit implicit() const override {
        if (d_.z == 0) return {true, p_.z};
        // x^2 + y^2 = |p + w d|^2 over x and y, with w = (z - z1) / dz.
        double A = d_.x * d_.x + d_.y * d_.y, B = p_.x * d_.x + p_.y * d_.y, C = p_.x * p_.x + p_.y * p_.y;
        double k = 1 / d_.z, w0 = -p_.z * k;
        return {false, 0, -A * k * k, -2 * k * (A * w0 + B), -(A * w0 * w0 + 2 * B * w0 + C)};
    }
    double vOf(const Vec3d& p) const override {
        if (d_.z != 0) return (p.z - p_.z) / d_.z;
        double t[2];
        return flatV(p, t) ? t[0] : -1;
    }
    std::optional<double> secondV(const Vec3d& p) const override {
        double t[2];
        if (d_.z != 0 || flatV(p, t) != 2) return {};
        return t[1];
    }
    // A flat ring: v where the line is as far from the axis as p; up to two.
    int flatV(const Vec3d& p, double t[2]) const {
        return solveQuadratic(d_.x * d_.x + d_.y * d_.y, p_.x * d_.x + p_.y * d_.y,
                              p_.x * p_.x + p_.y * p_.y - p.x * p.x - p.y * p.y, t);
    }
    Vec3d p_, d_;
};

} // namespace

ShapeRef makeHyperboloid(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double n[7];
    for (size_t i = 0; i < 7; ++i) n[i] = quadricNumber(p, i, ok);
    if (!ok) return reportDegenerate(p, diag, "needs seven finite numbers"), nullptr;
    Vec3d p1(n[0], n[1], n[2]), p2(n[3], n[4], n[5]);
    if (p1 == p2 || n[6] == 0) return reportDegenerate(p, diag, "has no length or no sweep"), nullptr;
    if (n[0] == 0 && n[1] == 0 && n[3] == 0 && n[4] == 0) return reportDegenerate(p, diag, "lies on its axis"), nullptr;
    return std::make_shared<Hyperboloid>(std::move(s), p1, p2, n[6], diag);
}

} // namespace alpenglow::geometry

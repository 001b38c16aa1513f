// Torus majorrad minorrad phimin phimax thetamax.
#include "base/exact.h"
#include "geometry/factories.h"
#include "geometry/quadric.h"
#include "geometry/solve.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {
namespace {

class Torus final : public Quadric {
public:
    Torus(ShapeSource s, double R, double r, double phi0, double phi1, double sweep, Diagnostics& d)
        : Quadric(std::move(s), sweep, d), R_(R), r_(r), phi0_(phi0), phi1_(phi1), size_(std::fabs(R) + std::fabs(r)),
          high_(std::fabs(r) / size_ + kRoom), hole_((std::fabs(R) - std::fabs(r)) / size_ - kRoom) {
        finish(d);
    }
    std::optional<QuadricForm> form() const override {
        std::optional<QuadricForm> f = Quadric::form();
        if (f) f->kind = QuadricForm::Kind::Ring, f->size = size_, f->high = high_, f->hole = hole_, f->room = kRoom;
        return f;
    }

private:
    Profile profile(double v) const override {
        const double k = phi1_ - phi0_;
        const auto [s, c] = exact::sinCos(phi0_ + v * k);
        return {{R_ + r_ * c, 0, r_ * s}, {-r_ * k * s, 0, r_ * k * c}, {-r_ * k * k * c, 0, -r_ * k * k * s}};
    }
    Implicit implicit() const override { return {}; }
    bool closedV() const override { return std::fabs(phi1_ - phi0_) >= 2 * kPi - 1e-6; }

    /// Signed distance from the tube, well conditioned for thin tubes, and its derivative along a ray with direction d.
    struct Distance {
        double f, slope;
    };
    Distance distance(const Vec3d& p, const Vec3d& d) const {
        const double rho = exact::hypot(p.x, p.y), near = exact::hypot(rho - R_, p.z), r = std::fabs(r_);
        // Self-crossing tori have an inner sheet, where the circle is on the other side of the axis.
        const double far = exact::hypot(rho + R_, p.z);
        const bool other = std::fabs(far - r) < std::fabs(near - r);
        const double across = other ? rho + R_ : rho - R_, length = other ? far : near;
        return {length - r, (across * (p.x * d.x + p.y * d.y) / rho + p.z * d.z) / length};
    }

    /// Interval where a ray p + s q, scaled to a torus of size 1 and unit speed, may hit it: inside of the bounding sphere,
    /// within the tube's height, and not entirely in the hole. Returns false if there is none.
    bool clip(const Vec3d& p, const Vec3d& q, double s[2]) const {
        if (solveQuadratic(1, dot(p, q), dot(p, p) - (1 + kRoom), s) != 2) return false;
        if (q.z != 0) {
            const double a = (-high_ - p.z) / q.z, b = (high_ - p.z) / q.z;
            s[0] = std::max(s[0], std::min(a, b));
            s[1] = std::min(s[1], std::max(a, b));
        } else if (std::fabs(p.z) > high_) {
            return false;
        }
        if (!(s[0] <= s[1])) return false;
        const auto far = [&](double at) { // squared distance from the axis: largest at one of the ends
            const double x = p.x + q.x * at, y = p.y + q.y * at;
            return x * x + y * y;
        };
        return !(hole_ > 0 && far(s[0]) < hole_ * hole_ && far(s[1]) < hole_ * hole_);
    }

    int roots(const Vec3d& o, const Vec3d& d, double t[4]) const override {
        const double size = size_, speed = length(d);
        const Vec3d p = o / size, q = d / speed;
        double s[2];
        if (!clip(p, q, s)) return 0;
        const double R2 = R_ * R_ / (size * size), r2 = r_ * r_ / (size * size);
        // (|p + s q|^2 + R^2 - r^2)^2 = 4 R^2 (x^2 + y^2)
        const double b = dot(p, q), k = dot(p, p) + R2 - r2;
        const double xy0 = p.x * p.x + p.y * p.y, xy1 = p.x * q.x + p.y * q.y, xy2 = q.x * q.x + q.y * q.y;
        const double c[5] = {k * k - 4 * R2 * xy0, 4 * b * k - 8 * R2 * xy1, 4 * b * b + 2 * k - 4 * R2 * xy2, 4 * b, 1};
        double x[4];
        const int n = polynomialRoots(c, 4, s[0], s[1], x);
        for (int i = 0; i < n; ++i) {
            // The quartic squares the distance; a few Newton steps on the distance itself restore precision.
            double at = x[i] * size / speed;
            Distance here = distance(o + d * at, d);
            for (int step = 0; step < 3; ++step) {
                const double next = at - here.f / here.slope;
                if (!std::isfinite(next) || std::fabs(next - at) > 1e-6 * size / speed) break;
                const Distance there = distance(o + d * next, d);
                if (!(std::fabs(there.f) < std::fabs(here.f))) break;
                at = next;
                here = there;
            }
            t[i] = at;
        }
        std::sort(t, t + n);
        return n;
    }
    double vOf(const Vec3d& p) const override {
        double rho = exact::hypot(p.x, p.y);
        double near = std::fabs(exact::hypot(rho - R_, p.z) - std::fabs(r_)),
               far = std::fabs(exact::hypot(-rho - R_, p.z) - std::fabs(r_));
        if (far < near) rho = -rho;
        double phi = exact::atan2(r_ < 0 ? -p.z : p.z, r_ < 0 ? R_ - rho : rho - R_);
        double k = phi1_ - phi0_, turn = 2 * kPi / k;
        // phi is known up to full turns: takes the one nearest inside the range.
        double v = (phi - phi0_) / k;
        v -= std::floor(v / std::fabs(turn)) * std::fabs(turn);
        if (v > 1 && v - std::fabs(turn) > -1e-7) v -= std::fabs(turn);
        return v;
    }
    static constexpr double kRoom = 1e-4;
    double R_, r_, phi0_, phi1_;
    double size_;        ///< largest radius
    double high_, hole_; ///< half the tube's height, and the hole's radius, with tolerance; relative to size_
};

} // namespace

ShapeRef makeTorus(ShapeSource s, Diagnostics& diag) {
    const scene::Primitive& p = *s.primitive;
    bool ok = true;
    double n[5];
    for (size_t i = 0; i < 5; ++i) n[i] = quadricNumber(p, i, ok);
    if (!ok) return reportDegenerate(p, diag, "needs five finite numbers"), nullptr;
    if (n[1] == 0 || n[4] == 0 || n[2] == n[3])
        return reportDegenerate(p, diag, "has no tube, no sweep or no phi range"), nullptr;
    double phi0 = n[2] * kPi / 180, phi1 = n[3] * kPi / 180;
    if (std::fabs(phi1 - phi0) > 2 * kPi * (1 + 1e-9)) {
        diag.report(Severity::Warning, Rie::Range, p.place,
                    "Torus has more than 360 degrees between phimin and phimax; 360 are drawn");
        phi1 = phi0 + std::copysign(2 * kPi, phi1 - phi0);
    }
    return std::make_shared<Torus>(std::move(s), n[0], n[1], phi0, phi1, n[4], diag);
}

} // namespace alpenglow::geometry

#include "geometry/edge_curve.h"
#include "base/exact.h"
#include "base/limits.h"
#include <algorithm>
#include <cmath>
#include <tuple>

namespace alpenglow::geometry {

namespace {
constexpr int kMostSegments = 32; ///< of a uniformly cut part
constexpr int kDeepestEdge = 20;  ///< halvings

Vec3d single(const Vec3d& v) { return Vec3d(Vec3(v)); }
bool before(const Vec3d& a, const Vec3d& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }
} // namespace

EdgeCurve EdgeCurve::line(const Vec3d& from, const Vec3d& to) {
    EdgeCurve e;
    e.a_ = single(from);
    e.b_ = single(to);
    e.collapsed_ = e.a_ == e.b_;
    if (before(e.b_, e.a_)) std::swap(e.a_, e.b_), e.reversed_ = true;
    return e;
}

EdgeCurve EdgeCurve::bezier(std::span<const std::array<double, 4>> points) {
    if (points.size() == 2 && points[0][3] == 1 && points[1][3] == 1) {
        const auto& [a, b] = std::tie(points[0], points[1]);
        return line({a[0], a[1], a[2]}, {b[0], b[1], b[2]});
    }
    EdgeCurve e;
    e.kind_ = Kind::Bezier;
    e.points_.assign(points.begin(), points.end());
    for (auto& p : e.points_)
        for (double& x : p) x = double(float(x));
    for (const auto& p : e.points_) e.rational_ |= p[3] != 1;
    e.reversed_ = std::lexicographical_compare(e.points_.rbegin(), e.points_.rend(), e.points_.begin(), e.points_.end());
    if (e.reversed_) std::reverse(e.points_.begin(), e.points_.end());
    const auto place = [](const std::array<double, 4>& p) { return single(Vec3d(p[0], p[1], p[2]) / p[3]); };
    e.collapsed_ =
        std::all_of(e.points_.begin(), e.points_.end(), [&](const auto& p) { return place(p) == place(e.points_[0]); });
    if (place(e.points_.front()) == place(e.points_.back())) e.fewest_ = 4;
    return e;
}

EdgeCurve EdgeCurve::arc(const Vec3d& centre, const Vec3d& x, const Vec3d& y, double sweep) {
    EdgeCurve e;
    e.kind_ = Kind::Arc;
    e.a_ = single(centre);
    e.b_ = single(x);
    e.c_ = single(sweep < 0 ? -y : y);
    e.sweep_ = std::fabs(sweep);
    e.collapsed_ = e.sweep_ == 0 || (dot(e.b_, e.b_) == 0 && dot(e.c_, e.c_) == 0);
    e.fewest_ = std::max(1.0, e.sweep_ / (kPi / 2) * 0.999);
    return e;
}

/// By differences of the points (de Casteljau): of degree n, the points of degree 2 and 1 hold the derivatives.
Vec3d EdgeCurve::bezierAt(double c, Vec3d* slope, Vec3d* bend) const {
    std::array<double, 4> p[limits::kNurbsOrder];
    const int n = int(points_.size()) - 1;
    std::copy(points_.begin(), points_.end(), p);
    const auto vec = [](const std::array<double, 4>& x) { return Vec3d(x[0], x[1], x[2]); };
    Vec3d d, dd;
    double dw = 0, ddw = 0;
    for (int k = n; k > 0; --k) {
        if (k == 2) {
            dd = (vec(p[2]) - vec(p[1]) * 2 + vec(p[0])) * double(n * (n - 1));
            ddw = (p[2][3] - p[1][3] * 2 + p[0][3]) * n * (n - 1);
        }
        if (k == 1) d = (vec(p[1]) - vec(p[0])) * double(n), dw = (p[1][3] - p[0][3]) * n;
        for (int i = 0; i < k; ++i)
            for (size_t x = 0; x < 4; ++x) p[i][x] = p[i][x] * (1 - c) + p[i + 1][x] * c;
    }
    const double w = rational_ ? p[0][3] : 1;
    const Vec3d at = rational_ ? vec(p[0]) / w : vec(p[0]);
    const Vec3d first = rational_ ? (d - at * dw) / w : d;
    if (slope) *slope = first;
    if (bend) *bend = rational_ ? (dd - first * (2 * dw) - at * ddw) / w : dd;
    return at;
}

Vec3d EdgeCurve::along(double c, Vec3d* slope, Vec3d* bend) const {
    if (kind_ == Kind::Bezier) return bezierAt(c, slope, bend);
    if (kind_ == Kind::Line) {
        if (slope) *slope = b_ - a_;
        if (bend) *bend = Vec3d(0.0);
        return a_ * (1 - c) + b_ * c;
    }
    const auto [s, k] = exact::sinCos(c * sweep_);
    const Vec3d out = b_ * k + c_ * s;
    if (slope) *slope = (c_ * k - b_ * s) * sweep_;
    if (bend) *bend = out * (-sweep_ * sweep_);
    return a_ + out;
}

/// Returns false if the visitor stops.
template <class Visit> bool EdgeCuts::walk(double t0, double t1, Visit& visit) const {
    if (const int n = segments(t0, t1); n > 0) return visit(t0, t1, n);
    const double middle = 0.5 * (t0 + t1);
    return walk(t0, middle, visit) && walk(middle, t1, visit);
}

EdgeCuts::EdgeCuts(std::span<const EdgeCurve> curves, const DiceCamera& camera, double micropolygon, double deviation,
                   bool displaced)
    : curves_(curves), camera_(camera), edge_(micropolygon), deviation_(deviation), displaced_(displaced) {
    // For the complete edge, so that it depends on nothing else.
    int n = 0;
    const auto count = [&](double, double, int k) { return (n += k) <= limits::kDiceEdge; };
    while (!walk(0, 1, count)) n = 0, coarse_ *= 2;
}

double EdgeCuts::need(double t0, double t1) const {
    double most = 0;
    for (const EdgeCurve& e : curves_) {
        const double c0 = e.reversed() ? 1 - t1 : t0, width = t1 - t0;
        double n = 0;
        for (double x : {0.1, 0.5, 0.9}) { // from the first end, for either direction of the edge
            Vec3d d, dd;
            const Vec3d p = e.along(c0 + width * x, &d, &dd);
            double l = camera_.pixels(p, d) / edge_;
            if (!displaced_) l = std::min(l, 1.5 * std::sqrt(camera_.pixels(p, dd) / (8 * deviation_)));
            n = std::max(n, l * width);
        }
        most = std::max(most, std::max(n / coarse_, e.fewest() * width));
    }
    return most;
}

int EdgeCuts::segments(double t0, double t1) const {
    const double n = need(std::min(t0, t1), std::max(t0, t1));
    if (n > kMostSegments) return std::fabs(t1 - t0) > std::ldexp(1.0, -kDeepestEdge) ? 0 : kMostSegments;
    int k = 1;
    while (k < n) k *= 2;
    return k;
}

std::vector<double> EdgeCuts::places() const {
    std::vector<double> out;
    const auto keep = [&](double t0, double t1, int n) {
        for (int i = 0; i < n; ++i) out.push_back(t0 + (t1 - t0) * i / n);
        return true;
    };
    walk(0, 1, keep);
    out.push_back(1);
    return out;
}

} // namespace alpenglow::geometry

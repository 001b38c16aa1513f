#include "geometry/edge_corners.h"
#include <algorithm>
#include <cmath>
#include <tuple>

namespace alpenglow::geometry {

namespace {
constexpr double kNear = 4e-7;       ///< relative to the largest coordinate: single precision error of a point on the edge
constexpr double kApart = 0x1p-18;   ///< of the edge
constexpr size_t kMostOnEdge = 4096; ///< on one edge
} // namespace

void EdgeCorners::add(const std::vector<double>& with, std::span<const Vec3> corners) {
    Points& p = points_[with];
    for (const Vec3& c : corners) p.push_back(c + Vec3(0.f)); // -0 is 0
}

void EdgeCorners::finish() {
    const auto place = [](const Vec3& p) { return std::tie(p.x, p.y, p.z); };
    for (auto& [with, p] : points_) {
        std::sort(p.begin(), p.end(), [&](const Vec3& a, const Vec3& b) { return place(a) < place(b); });
        p.erase(std::unique(p.begin(), p.end()), p.end());
        divide(p, 0);
    }
}

void EdgeCorners::divide(std::span<Vec3> p, int axis) {
    if (p.size() < 2) return;
    const size_t middle = p.size() / 2;
    std::nth_element(p.begin(), p.begin() + std::ptrdiff_t(middle), p.end(),
                     [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
    divide(p.first(middle), (axis + 1) % 3);
    divide(p.subspan(middle + 1), (axis + 1) % 3);
}

void EdgeCorners::collect(std::span<const Vec3> p, int axis, const Vec3& lo, const Vec3& hi, std::vector<Vec3>& out) {
    if (p.empty()) return;
    const size_t middle = p.size() / 2;
    const Vec3& m = p[middle];
    if (m.x >= lo.x && m.x <= hi.x && m.y >= lo.y && m.y <= hi.y && m.z >= lo.z && m.z <= hi.z) out.push_back(m);
    if (lo[axis] <= m[axis]) collect(p.first(middle), (axis + 1) % 3, lo, hi, out);
    if (hi[axis] >= m[axis]) collect(p.subspan(middle + 1), (axis + 1) % 3, lo, hi, out);
}

std::vector<EdgeCorners::On> EdgeCorners::within(const std::vector<double>& with, const Vec3d& a, const Vec3d& b) const {
    std::vector<On> on;
    const auto found = points_.find(with);
    const Vec3d d = b - a;
    const double length2 = dot(d, d);
    if (found == points_.end() || !(length2 > 0)) return on;
    double largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max({largest, std::fabs(a[k]), std::fabs(b[k])});
    const double room = kNear * largest;
    Vec3 lo, hi;
    for (int k = 0; k < 3; ++k) lo[k] = float(std::min(a[k], b[k]) - 2 * room), hi[k] = float(std::max(a[k], b[k]) + 2 * room);
    std::vector<Vec3> near;
    collect(found->second, 0, lo, hi, near);
    for (const Vec3& p : near) {
        const Vec3d to = Vec3d(p) - a;
        const double t = dot(to, d) / length2;
        const Vec3d away = to - d * t;
        if (t > kApart && t < 1 - kApart && dot(away, away) <= room * room) on.push_back({t, p});
    }
    std::sort(on.begin(), on.end(), [](const On& x, const On& y) {
        return x.t != y.t ? x.t < y.t : std::tie(x.P.x, x.P.y, x.P.z) < std::tie(y.P.x, y.P.y, y.P.z);
    });
    on.erase(std::unique(on.begin(), on.end(), [](const On& x, const On& y) { return y.t - x.t <= kApart; }), on.end());
    if (on.size() > kMostOnEdge) on.clear();
    return on;
}

} // namespace alpenglow::geometry

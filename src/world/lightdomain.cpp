#include "world/lightdomain.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::world {

namespace {

/// The rectangle around corners in a plane, parallel to a unit direction s; n: unit, its normal.
struct Around {
    Vec3d s, t;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    Around(const FlatEmitter& e, const Vec3d& along, const Vec3d& n) : s(along), t(cross(n, along)) {
        for (int i = 0; i < e.cornerCount; ++i) {
            const Vec3d c(e.corner[i][0], e.corner[i][1], e.corner[i][2]);
            const double at[2] = {dot(c, s), dot(c, t)};
            for (int k = 0; k < 2; ++k) low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
        }
    }
    double area() const { return (high[0] - low[0]) * (high[1] - low[1]); }
};

} // namespace

LightDomain::LightDomain(const FlatEmitter& e) : flat_(true) {
    const auto corner = [&](int t, int i) {
        const double* c = e.corner[e.corners[t][i % 3]];
        return Vec3d(c[0], c[1], c[2]);
    };
    Vec3d n(0.);
    for (int t = 0; t < e.count; ++t)
        if (const Vec3d m = cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)); dot(m, m) > dot(n, n)) n = m;
    n = normalize(n);
    Around best(e, normalize(corner(0, 1) - corner(0, 0)), n);
    for (int t = 0; t < e.count; ++t)
        for (int i = 0; i < 3; ++i) {
            const Vec3d edge = corner(t, i + 1) - corner(t, i);
            if (!(dot(edge, edge) > 0)) continue;
            if (const Around a(e, normalize(edge), n); a.area() < best.area() * (1 - 1e-9)) best = a;
        }
    const double width = best.high[0] - best.low[0], height = best.high[1] - best.low[1];
    const Vec3d first(e.corner[0][0], e.corner[0][1], e.corner[0][2]);
    n_ = Vec3(n);
    corner_ = Vec3(best.s * best.low[0] + best.t * best.low[1] + n * dot(first, n));
    edge_[0] = Vec3(best.s * width), edge_[1] = Vec3(best.t * height);
    per_[0] = Vec3(best.s / width), per_[1] = Vec3(best.t / height);
    area_ = float(width * height / double(kEdge * kEdge));
}

bool LightDomain::find(const Vec3& P, const Vec3& w, int& bin, float& density) const {
    if (!flat_) {
        const Vec3 a(std::fabs(w.x), std::fabs(w.y), std::fabs(w.z));
        const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
        const float per = 1 / std::max(a[axis], 1e-20f);
        const auto step = [&](int k) { return std::clamp(int((w[k] * per + 1) * (.5f * float(kFace))), 0, kFace - 1); };
        bin = ((2 * axis + (w[axis] < 0)) * kFace + step((axis + 2) % 3)) * kFace + step((axis + 1) % 3);
        density = per * per * per * (float(kFace * kFace) / 4); // a face is a square of edge 2
        return true;
    }
    const float facing = dot(w, n_), far = dot(corner_ - P, n_) / facing;
    if (!(far > 0) || !std::isfinite(far)) return false;
    const Vec3 at = P + w * far - corner_;
    const float x = dot(at, per_[0]) * float(kEdge), y = dot(at, per_[1]) * float(kEdge);
    constexpr float kRounding = 1e-3f; // of a bin: points at the edge of the emitter
    const auto within = [](float v) { return v >= -kRounding && v <= float(kEdge) + kRounding; };
    if (!within(x) || !within(y)) return false;
    const auto step = [](float v) { return std::clamp(int(v), 0, kEdge - 1); };
    bin = step(y) * kEdge + step(x);
    density = far * far / (std::fabs(facing) * area_);
    return std::isfinite(density);
}

Vec3 LightDomain::direction(const Vec3& P, int bin, Vec2 u) const {
    if (!flat_) {
        const int face = bin / (kFace * kFace), axis = face / 2;
        Vec3 w;
        w[axis] = face % 2 ? -1.f : 1.f;
        w[(axis + 1) % 3] = (float(bin % kFace) + u.x) * (2.f / float(kFace)) - 1;
        w[(axis + 2) % 3] = (float(bin / kFace % kFace) + u.y) * (2.f / float(kFace)) - 1;
        return normalize(w);
    }
    const float x = (float(bin % kEdge) + u.x) / float(kEdge), y = (float(bin / kEdge) + u.y) / float(kEdge);
    const Vec3 to = corner_ + edge_[0] * x + edge_[1] * y - P;
    const float l = length(to);
    return l > 0 ? to * (1 / l) : n_;
}

} // namespace alpenglow::world

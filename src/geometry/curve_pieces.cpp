#include "geometry/curve_pieces.h"
#include "geometry/bernstein.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

CurvePieces::CurvePieces(uint32_t parts) : weights_(parts) {
    for (uint32_t part = 0; part < parts; ++part)
        for (int j = 0; j < 4; ++j) {
            double one[4] = {};
            one[j] = 1;
            bernsteinPart<3>(one, double(part) / parts, double(part + 1) / parts);
            for (int i = 0; i < 4; ++i) weights_[part][size_t(4 * i + j)] = float(one[i]);
        }
}

void CurvePieces::take(const Vec3d p[4], double wide, const Vec3d& reach) {
    base_ = p[0];
    wide_ = wide;
    Vec3d most;
    for (int j = 0; j < 4; ++j) {
        const Vec3d d = p[j] - base_;
        from_[j] = Four{float(d.x), float(d.y), float(d.z), 0};
        most = {std::max(most.x, std::fabs(d.x)), std::max(most.y, std::fabs(d.y)), std::max(most.z, std::fabs(d.z))};
    }
    size_ = most.x + most.y + most.z;
    const double slack = 1e-6 * (std::fabs(base_.x) + std::fabs(base_.y) + std::fabs(base_.z) + size_) + 1e-30;
    reach_ = Four{float(reach.x + slack), float(reach.y + slack), float(reach.z + slack), 0};
}

void CurvePieces::points(uint32_t part, Four p[4]) const {
    const float* w = weights_[part].data();
    for (int i = 0; i < 4; ++i, w += 4) p[i] = (from_[0] * w[0] + from_[1] * w[1]) + (from_[2] * w[2] + from_[3] * w[3]);
}

Bounds CurvePieces::box(uint32_t part) const {
    Four p[4];
    points(part, p);
    const auto least = [](Four a, Four b) { return a < b ? a : b; };
    const auto most = [](Four a, Four b) { return a > b ? a : b; };
    const Four base{float(base_.x), float(base_.y), float(base_.z), 0};
    const Four lo = base + (least(least(p[0], p[1]), least(p[2], p[3])) - reach_),
               hi = base + (most(most(p[0], p[1]), most(p[2], p[3])) + reach_);
    Bounds b;
    b.lo = {lo[0], lo[1], lo[2]};
    b.hi = {hi[0], hi[1], hi[2]};
    return b;
}

Capsule CurvePieces::capsule(uint32_t part) const {
    Four p[4];
    points(part, p);
    const auto dot = [](Four a, Four b) {
        const Four c = a * b;
        return c[0] + c[1] + c[2];
    };
    // Distance of the inner points from the chord. The centre deviates from it by B1(f) off[0] + B2(f) off[1] with B1 + B2 <=
    // 3/4, i.e. within the triangle of 0 and 3/4 of both, around which the capsule is placed.
    const Four e = p[3] - p[0];
    const float ee = dot(e, e);
    Four off[2];
    for (int i = 0; i < 2; ++i) {
        const Four w = p[i + 1] - p[0];
        const float s = ee > 0 ? std::clamp(dot(w, e) / ee, 0.f, 1.f) : 0;
        off[i] = (w - e * s) * 0.75f;
    }
    const Four shift = (off[0] + off[1]) * 0.25f, a = off[0] - shift, b = off[1] - shift;
    const float bent = std::sqrt(std::max(dot(shift, shift), std::max(dot(a, a), dot(b, b))));
    const auto placed = [&](Four v) { return base_ + Vec3d(double(v[0]), double(v[1]), double(v[2])); };
    return Capsule::between(placed(p[0] + shift), placed(p[3] + shift), wide_ + double(bent) + 2e-6 * size_);
}

} // namespace alpenglow::geometry

#include "geometry/curve_boxes.h"
#include "geometry/curve_pieces.h"
#include <algorithm>
#include <cmath>

namespace alpenglow::geometry {

namespace {

/// Half the width at the most; of straight pieces with their mitres.
double halfWidthOf(const CurveSegment& g) { return g.linear ? 2 * g.widest() : g.widest(); }

} // namespace

CurveBoxes::CurveBoxes(const CurveSet& set, const Matrix& toCamera, uint32_t parts)
    : set_(set), toCamera_(toCamera), parts_(parts) {
    const auto& m = toCamera.m;
    affine_ = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    for (int k = 0; k < 3; ++k) reach_[k] = std::sqrt(m[0][k] * m[0][k] + m[1][k] * m[1][k] + m[2][k] * m[2][k]);
    // The largest singular value squared is below each sum of a row of the product with the transpose.
    stretch_ = 0;
    for (int i = 0; i < 3; ++i) {
        double sum = 0;
        for (int k = 0; k < 3; ++k) sum += std::fabs(m[i][0] * m[k][0] + m[i][1] * m[k][1] + m[i][2] * m[k][2]);
        stretch_ = std::max(stretch_, std::sqrt(sum));
    }
}

/// As transformPoint(), which divides by 1 then.
Vec3d CurveBoxes::toCamera(const Vec3d& p) const {
    if (!affine_) return transformPoint(toCamera_, p);
    const auto& m = toCamera_.m;
    return {p.x * m[0][0] + p.y * m[1][0] + p.z * m[2][0] + m[3][0], p.x * m[0][1] + p.y * m[1][1] + p.z * m[2][1] + m[3][1],
            p.x * m[0][2] + p.y * m[1][2] + p.z * m[2][2] + m[3][2]};
}

Vec3d CurveBoxes::reachOf(double wide) const {
    return {reach_[0] * wide * 1.000001, reach_[1] * wide * 1.000001, reach_[2] * wide * 1.000001};
}

/// Points whose convex hull contains the centre line of a primitive.
int CurveBoxes::hull(const CurveSegment& g, uint32_t prim, Vec3d p[4]) const {
    const double from = double(prim % parts_) / parts_, to = double(prim % parts_ + 1) / parts_;
    const int n = g.linear ? 2 : 4;
    if (g.linear) {
        p[0] = g.p[1] + (g.p[2] - g.p[1]) * from;
        p[1] = g.p[1] + (g.p[2] - g.p[1]) * to;
    } else {
        std::copy(g.p, g.p + 4, p);
        bernsteinPart<3>(p, from, to);
    }
    for (int i = 0; i < n; ++i) p[i] = toCamera(p[i]);
    return n;
}

void CurveBoxes::bounds(uint32_t first, std::span<Bounds> out) const {
    CurveSegment g;
    Vec3d reach;
    uint32_t loaded = kNone;
    for (uint32_t prim = first; Bounds & b : out) {
        if (prim / parts_ != loaded) {
            set_.load(loaded = prim / parts_, g);
            reach = reachOf(halfWidthOf(g));
        }
        Vec3d p[4];
        const int n = hull(g, prim++, p);
        Vec3d lo(INFINITY), hi(-INFINITY);
        for (int i = 0; i < n; ++i) {
            const Vec3d& c = p[i];
            const double slack = 1e-6 * (std::fabs(c.x) + std::fabs(c.y) + std::fabs(c.z)) + 1e-30;
            const Vec3d r = reach + Vec3d(slack), from = c - r, to = c + r;
            lo = {std::min(lo.x, from.x), std::min(lo.y, from.y), std::min(lo.z, from.z)};
            hi = {std::max(hi.x, to.x), std::max(hi.y, to.y), std::max(hi.z, to.z)};
        }
        b.lo = Vec3(lo), b.hi = Vec3(hi);
    }
}

/// out: f(pieces of its segment, its part) of each primitive, all being cubic.
template <class Out, class F> void CurveBoxes::eachPiece(uint32_t first, std::span<Out> out, F f) const {
    CurvePieces pieces(parts_);
    CurveSegment g;
    uint32_t loaded = kNone;
    for (uint32_t prim = first; Out & o : out) {
        if (prim / parts_ != loaded) {
            set_.load(loaded = prim / parts_, g);
            Vec3d p[4];
            for (int i = 0; i < 4; ++i) p[i] = toCamera(g.p[i]);
            const double wide = halfWidthOf(g);
            pieces.take(p, wide * stretch_ * 1.000001, reachOf(wide));
        }
        o = f(pieces, prim++ % parts_);
    }
}

void CurveBoxes::quickBounds(uint32_t first, std::span<Bounds> out, const Bounds& all) const {
    eachPiece(first, out, [](const CurvePieces& p, uint32_t part) { return p.box(part); });
    for (Bounds& b : out)
        for (int a = 0; a < 3; ++a) b.lo[a] = std::max(b.lo[a], all.lo[a]), b.hi[a] = std::min(b.hi[a], all.hi[a]);
}

void CurveBoxes::capsules(uint32_t first, std::span<Capsule> out) const {
    if (quick()) return eachPiece(first, out, [](const CurvePieces& p, uint32_t part) { return p.capsule(part); });
    CurvePieces piece(1);
    for (uint32_t prim = first; Capsule & c : out) {
        CurveSegment g;
        set_.load(prim / parts_, g);
        Vec3d p[4];
        if (hull(g, prim++, p) == 2) p[2] = p[3] = p[1], p[1] = p[0];
        piece.take(p, halfWidthOf(g) * stretch_ * 1.000001, Vec3d(0.0));
        c = piece.capsule(0);
    }
}

} // namespace alpenglow::geometry
